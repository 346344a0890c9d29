"""Takes a picture of a page, for the README.

usage: picture.py PAGE.html PICTURE.png [--seconds 3] [--size 1400x880] [--dark] [--phone]
"""
import argparse
import pathlib
import sys
import time

import browser


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path)
    parser.add_argument("--seconds", type=float, default=3)
    parser.add_argument("--size", default="1400x880")
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--phone", action="store_true", help="two pixels of the picture to one of the page")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    window = browser.start()
    if window is None:
        return 1
    try:
        browser.resize(window, width, height, scale=2 if options.phone else 1, mobile=options.phone,
                       dark=options.dark)
        window.get(options.page.resolve().as_uri())
        while not window.execute_script("return document.getElementById('time').textContent"):
            time.sleep(0.02)
        # As a person would: a second at a time, then frame by frame.
        keys = ["Home"] + ["ArrowRight"] * int(options.seconds)
        rest = ["ArrowRight"] * round(options.seconds % 1 * 15)
        for key, shift in [(key, key != "Home") for key in keys] + [(key, False) for key in rest]:
            window.execute_script("document.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0],"
                                  "shiftKey: arguments[1], bubbles: true}))", key, shift)
        time.sleep(0.3)
        options.picture.parent.mkdir(parents=True, exist_ok=True)
        window.save_screenshot(str(options.picture))
    finally:
        window.quit()
    return 0


if __name__ == "__main__":
    sys.exit(main())
