#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Checks the decoder, or the proof, on its own: it refers to no files, memory maps, threads, clocks,
# sockets, processes or environment, does not contain CGAL's tetrahedralization (CGAL's exact
# numbers remain), and takes the golden blobs.
# usage: portable.sh PROGRAM GOLDEN_BLOBS LEAST_TAKEN MOST_DECLINED
set -eu

program=$1
goldens=$2
least_taken=$3
most_declined=$4

calls='open|openat|creat|fopen|freopen|mmap|munmap|shm_open|pthread_[a-z_]*|thrd_[a-z]*|sem_[a-z]*'
calls="$calls|clock|clock_gettime|gettimeofday|time|nanosleep|usleep|sleep|getenv|secure_getenv"
calls="$calls|setenv|socket|connect|fork|vfork|exec[a-z]*|posix_spawn|system|popen|kill|signal"
calls="$calls|sigaction|syscall|getpid|getrandom|rand|random|dlopen|stat|fstat|readdir|opendir"
# A lock is no call where there are no other threads.
if nm -D --undefined-only "$program" | sed 's/@.*//' |
  grep -vwE 'U pthread_mutex_(un)?lock' | grep -wE "U ($calls)"; then
  echo "the program calls the operating system"
  exit 1
fi
if nm -DC --undefined-only "$program" |
  grep -E 'std::(thread|mutex|condition_variable|chrono|filesystem|random_device|basic_[io]?fstream)'; then
  echo "the program uses what needs an operating system"
  exit 1
fi
if nm -C "$program" | grep -E 'CGAL::Triangulation_3|Delaunay_triangulation_3' | head -n 3 | grep .; then
  echo "the program contains CGAL's tetrahedralization"
  exit 1
fi

# Only the standard libraries of C and C++ are allowed, and GMP, which needs no operating system. A
# linker may name MPFR although it has left out every function that calls it.
if nm -D --undefined-only "$program" | grep -E 'U mpfr_'; then
  echo "the program calls MPFR"
  exit 1
fi
if readelf -d "$program" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
  grep -vE '^(libgmp|libmpfr|libstdc\+\+|libm|libgcc_s|libc|ld-linux[a-z0-9_-]*)\.so'; then
  echo "the program needs another library"
  exit 1
fi

taken=0
declined=0
for blob in "$goldens"/version-1/*.blob; do
  status=0
  reason=$("$program" <"$blob") || status=$?
  case $status in
    0) taken=$((taken + 1)) ;;
    *)
      case $reason in
        *"only CGAL takes"*) declined=$((declined + 1)) ;;
        *) echo "$blob: $reason" && exit 1 ;;
      esac
      ;;
  esac
done
echo "$taken golden blobs taken, $declined declined: their coordinates are not whole"
[ "$taken" -ge "$least_taken" ] && [ "$declined" -le "$most_declined" ]
