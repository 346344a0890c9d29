#!/bin/bash
# Installs the build, then builds and runs the consumers against it by CMake package and pkg-config.
# Usage: consumer_test.sh SOURCE BUILD WEIGHTS
set -euo pipefail
source=$1/tests/consumer build=$2 weights=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -S "$source" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
      -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/build" >/dev/null

# One second of silence: the header of a WAV file of 16-bit samples at 16 kHz, then zeros.
{
  printf 'RIFF\x24\x7d\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x80\x3e\0\0\0\x7d\0\0\x02\0\x10\0data\0\x7d\0\0'
  head -c 32000 /dev/zero
} >"$work/sound.wav"
printf '0.1 0.4 Good\n0.5 0.9 morning.\n' >"$work/words.txt"

# pkg-config knows the prefix that was configured; the files moved, so it is told where they are.
PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name gestus.pc)")
export PKG_CONFIG_PATH
flags_of() { pkg-config --define-variable=prefix="$work/prefix" --cflags --libs "$@"; }

# consume NAME "PACKAGE..." ARGUMENT...: runs NAME as CMake built it and as pkg-config says.
consume() {
  local name=$1 packages=$2
  shift 2
  "$work/build/$name" "$@"
  # shellcheck disable=SC2046,SC2086
  c++ -std=c++20 "$source/$name.cc" -o "$work/$name" $(flags_of $packages)
  "$work/$name" "$@"
}

consume main gestus "$weights"
consume words "gestus-audio gestus-words" "$work/words.txt" "$work/sound.wav"
# These are there unless libutf8proc was not.
if [[ -x "$work/build/text" ]]; then
  consume text gestus-text
  consume features gestus-features "$weights" "$work/sound.wav" "$work/words.txt"
fi

# Whatever an installed header includes is installed as well, or part of C++ itself.
(cd "$work/prefix/include/gestus" && find . -name '*.h' -printf '#include "%P"\n') >"$work/all.cc"
grep -q 'models/audio/source.h' "$work/all.cc"
# shellcheck disable=SC2046
c++ -std=c++20 -fsyntax-only "$work/all.cc" $(pkg-config --define-variable=prefix="$work/prefix" \
  --cflags gestus)
