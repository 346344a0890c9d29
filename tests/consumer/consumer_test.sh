#!/bin/bash
# Installs the build, then builds and runs the consumer against it by CMake package and pkg-config.
# Usage: consumer_test.sh SOURCE BUILD WEIGHTS
set -euo pipefail
source=$1 build=$2 weights=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -S "$source/tests/consumer" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" \
      -DCMAKE_BUILD_TYPE=Release >/dev/null
cmake --build "$work/build" >/dev/null
"$work/build/consumer" "$weights"

# pkg-config knows the prefix that was configured; the files moved, so it is told where they are.
PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name gestus.pc)")
export PKG_CONFIG_PATH
flags_of() { pkg-config --define-variable=prefix="$work/prefix" --cflags --libs "$1"; }
# shellcheck disable=SC2046
c++ -std=c++20 "$source/tests/consumer/main.cc" -o "$work/by_pkg_config" $(flags_of gestus)
"$work/by_pkg_config" "$weights"

# The tokeniser is there unless libutf8proc was not.
if [[ -x "$work/build/text_consumer" ]]; then
  "$work/build/text_consumer"
  # shellcheck disable=SC2046
  c++ -std=c++20 "$source/tests/consumer/text.cc" -o "$work/text_by_pkg_config" \
      $(flags_of gestus-text)
  "$work/text_by_pkg_config"
fi
