#!/bin/bash
# No system call between the two getppid() calls of steady_state with one thread; with two threads
# only those by which they wait for each other or, once a run, keep off each other's processor.  Exit
# 77 (skipped) where tracing is not to be had.
# Usage: no_syscalls.sh STEADY_STATE WEIGHTS THREADS REPEATS ALLOWED
set -euo pipefail
program=$1 weights=$2 threads=$3 repeats=$4 allowed=$5
command -v strace >/dev/null || { echo "skipped: no strace"; exit 77; }
strace -o /dev/null true 2>/dev/null || { echo "skipped: tracing is not permitted"; exit 77; }
log=$(mktemp)
trap 'rm -f "$log"' EXIT
strace -f -qq -o "$log" "$program" "$weights" "$threads" "$repeats"
found=$(awk -v allowed="$allowed" '
  /getppid/ { if (/ getppid\(/) ++marks; next }  # a call may be shown in two lines
  marks == 1 && !(allowed != "" && $0 ~ allowed) { print }' "$log")
[[ $(grep -c ' getppid(' "$log") -eq 2 ]] || { echo "the two marks are missing"; exit 1; }
if [[ -n $found ]]; then
  echo "system calls in the steady state:"
  head -n 5 <<<"$found"
  exit 1
fi
# A worker that joins a run asks for the caller's processors and leaves one of them: two calls.  A
# repetition is two runs, that of the style encoder and that of the generator.
moves=$(awk '/getppid/ { if (/ getppid\(/) ++marks } marks == 1 && /affinity\(/ { ++n }
  END { print n + 0 }' "$log")
most=$((4 * repeats * (threads - 1)))
if [[ $moves -gt $most ]]; then
  echo "$moves calls for the affinity of threads, expected at most $most"
  exit 1
fi
echo "$repeats runs with $threads thread(s): none${allowed:+ but $allowed}"
