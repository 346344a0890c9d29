"""Plays pages in a real browser, from the file system and without a network.

usage: player_test.py INFER_CLI
"""
import pathlib
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import browser  # noqa: E402
import player_data  # noqa: E402

INFER_CLI = sys.argv.pop(1)
SKIP = 77
# What a person would see, read in one go: the sound's time and the numbers below the figure.
STATE = """
const text = (id) => document.getElementById(id).textContent, sound = document.getElementById("sound");
return {sound: sound.currentTime, playing: !sound.paused, frame: Number(text("frame")), time: text("time"),
        word: document.querySelector("#caption .now")?.textContent ?? "",
        label: document.getElementById("play").getAttribute("aria-label"),
        now: Number(document.getElementById("tracks").getAttribute("aria-valuenow"))};
"""
# The longest time between two pictures, in seconds, into window.gap: a busy machine draws late.
WATCH = """
window.gap = 0;
let last = performance.now();
requestAnimationFrame(function watch() {
  const now = performance.now();
  window.gap = Math.max(window.gap, (now - last) / 1000);
  last = now;
  requestAnimationFrame(watch);
});
"""
# A number that changes with the picture, and how many colours it has.
PICTURE = """
const canvas = document.querySelectorAll("canvas")[arguments[0]];
const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", {willReadFrequently: true});
copy.drawImage(canvas, 0, 0);
const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
let sum = 0;
const colours = new Set();
for (let i = 0; i < data.length; i += 4) {
  const colour = data[i] + 256 * data[i + 1] + 65536 * data[i + 2];
  sum = (sum * 31 + colour + data[i + 3]) % 1000000007;
  if (data[i + 3] > 0) colours.add(colour);
}
return [sum, colours.size];
"""


class PlayerTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.pages = player_data.make(INFER_CLI, cls.folder.name)
        cls.browser = BROWSER

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def open(self, page, width=1400, height=900, **wishes):
        browser.resize(self.browser, width, height, **wishes)
        self.browser.get((self.pages / page).as_uri())
        self.wait(lambda: self.run_script("return document.getElementById('frames').textContent !== ''"
                                          " && document.getElementById('time').textContent !== ''"))
        self.wait(lambda: self.run_script("const s = document.getElementById('sound');"
                                          "return !s.getAttribute('src') || s.duration > 0"))

    def run_script(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def state(self):
        return self.run_script(STATE)

    def press(self, key, shift=False):
        """A key as the page gets it; the next picture is drawn before this returns."""
        self.browser.execute_async_script(
            "document.dispatchEvent(new KeyboardEvent('keydown', {key: arguments[0], shiftKey: arguments[1],"
            "bubbles: true, cancelable: true}));"
            "requestAnimationFrame(() => requestAnimationFrame(() => arguments[2]()));", key, shift)

    def wait(self, condition):
        end = time.monotonic() + 20
        while not condition():
            self.assertLess(time.monotonic(), end, "waited for too long")
            time.sleep(0.02)

    def tearDown(self):
        complaints = [entry for entry in self.browser.get_log("browser")
                      if entry["level"] in ("SEVERE", "WARNING")]
        self.assertEqual(complaints, [])

    def follow_the_sound(self, rate, speed=1):
        """While it plays, the frame shown is that of the sound's time."""
        self.run_script(WATCH)
        self.wait(lambda: self.state()["sound"] > 0.1)
        states = []
        while not states or states[-1]["sound"] - states[0]["sound"] < 1:
            states.append(self.state())
            self.assertTrue(states[-1]["playing"])
            time.sleep(0.03)
        late = self.run_script("return window.gap") * speed * rate
        for state in states:  # shown when the screen was last drawn: a picture or two ago
            behind = state["sound"] * rate - (state["frame"] + 0.5)
            self.assertTrue(-2 <= behind <= 2 + late, (state, late))
        frames = [state["frame"] for state in states]
        self.assertEqual(frames, sorted(frames))
        self.assertGreater(len(set(frames)), 2)
        return states

    def test_figure_follows_the_sound(self):
        self.open("body.html")
        before = self.run_script(PICTURE, 0)
        self.assertGreater(before[1], 20, "the figure's picture is blank")
        self.assertGreater(self.run_script(PICTURE, 1)[1], 20, "the timeline is blank")
        self.press(" ")
        states = self.follow_the_sound(15)
        self.assertGreater(len({state["word"] for state in states}), 1)
        self.press(" ")
        stopped = self.state()
        self.assertFalse(stopped["playing"])
        self.assertEqual(stopped["label"], "Play")
        self.assertNotEqual(self.run_script(PICTURE, 0)[0], before[0])
        time.sleep(0.1)
        self.assertEqual(self.state()["frame"], stopped["frame"])

    def test_head_follows_the_sound_at_its_own_rate(self):
        self.open("head.html")
        self.assertGreater(self.run_script(PICTURE, 0)[1], 20)
        self.press("ArrowUp")  # to one and a half
        self.press(" ")
        self.follow_the_sound(24, 1.5)
        self.assertEqual(self.run_script("return document.getElementById('sound').playbackRate"), 1.5)

    def test_keys(self):
        self.open("body.html")
        for key, shift, frame in (("ArrowRight", False, 1), ("ArrowRight", False, 2),
                                  ("ArrowLeft", False, 1), ("ArrowRight", True, 16),
                                  ("ArrowLeft", True, 1), ("End", False, 95), ("ArrowRight", False, 95),
                                  ("ArrowLeft", False, 94), ("Home", False, 0), ("ArrowLeft", False, 0)):
            self.press(key, shift)
            self.assertEqual(self.state()["frame"], frame, key)
        self.press(".")
        self.assertEqual(self.state()["word"], "And")
        self.press(".")
        self.assertEqual(self.state()["word"], "Mr")
        self.press(",")
        self.assertEqual(self.state()["word"], "And")
        self.assertIn("And", self.run_script(
            "return document.getElementById('tracks').getAttribute('aria-valuetext')"))
        self.press("?")
        self.assertTrue(self.run_script("return document.getElementById('help').open"))
        self.run_script("document.getElementById('help').close()")
        self.press("d")
        self.assertEqual(self.run_script("return document.documentElement.dataset.theme"), "dark")

    def test_loop(self):
        self.open("body.html")
        self.press("Home")
        for _ in range(3):
            self.press("ArrowRight")
        self.press("[")
        for _ in range(6):
            self.press("ArrowRight")
        self.press("]")
        self.assertEqual(self.run_script("return document.getElementById('loop').ariaPressed"), "true")
        self.press(" ")
        frames = []
        while len(frames) < 2 or frames[-1] >= frames[-2]:
            frames.append(self.state()["frame"])
            self.assertLess(len(frames), 2000, "never went back")
        self.press(" ")
        self.assertLessEqual(max(frames), 10)
        self.assertGreaterEqual(min(frames[-1], 9), 3)

    def test_dragging_moves_in_time(self):
        from selenium.webdriver.common.action_chains import ActionChains
        self.open("body.html")
        tracks = self.browser.find_element("id", "tracks")
        ActionChains(self.browser).move_to_element_with_offset(tracks, 0, 0).click().perform()
        self.wait(lambda: 0 < self.state()["now"] < 6.4)
        first = self.state()["now"]
        ActionChains(self.browser).move_to_element_with_offset(tracks, 0, 0).click_and_hold() \
            .move_by_offset(120, 0).release().perform()
        self.wait(lambda: self.state()["now"] > first + 0.3)

    def test_sizes_and_themes(self):
        for page in ("body.html", "compare.html", "head.html"):
            for width, height, dark in ((390, 844, False), (320, 568, True), (1400, 900, True)):
                self.open(page, width, height, dark=dark, mobile=width < 500, calm=dark)
                with self.subTest(page=page, width=width):
                    wide = self.run_script("return document.documentElement.scrollWidth")
                    self.assertLessEqual(wide, width)
                    for canvas in range(2):
                        self.assertGreater(self.run_script(PICTURE, canvas)[1], 20)
                    self.assertEqual(self.run_script("return document.documentElement.dataset.theme"),
                                     "dark" if dark else "light")
        self.assertEqual(self.run_script("return document.getElementById('trails').ariaPressed"), "false")

    def test_three_stand_side_by_side(self):
        self.open("compare.html")
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figcaption')]"
                                         ".map((caption) => caption.textContent)"),
                         ["Source", "Prediction", "Target"])
        pictures = [self.run_script(PICTURE, canvas)[0] for canvas in range(3)]
        self.assertEqual(len(set(pictures)), 3)

    def test_without_sound_it_plays_by_the_clock(self):
        self.open("silent.html")
        self.press(" ")
        self.wait(lambda: self.state()["frame"] >= 3)
        self.wait(lambda: self.state()["label"] == "Play")  # it has come to its end
        self.assertEqual(str(self.state()["frame"] + 1),
                         self.run_script("return document.getElementById('frames').textContent"))

    def test_words_are_text(self):
        self.open("body.html")
        self.assertIn("<b>leisure</b>", self.run_script("return document.getElementById('caption').textContent"))
        self.assertEqual(self.run_script("return document.querySelectorAll('#caption b').length"), 0)
        self.assertTrue(self.run_script("return !document.getElementById('untrained').hidden"))


if __name__ == "__main__":
    BROWSER = browser.start()
    if BROWSER is None:
        sys.exit(SKIP)
    try:
        RESULT = unittest.main(exit=False).result
    finally:
        BROWSER.quit()
    sys.exit(not RESULT.wasSuccessful())
