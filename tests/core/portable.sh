#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Checks the decoder on its own: it refers to no files, memory maps, threads, clocks, sockets,
# processes or environment, does not contain CGAL's tetrahedralization (CGAL's exact numbers
# remain), and decodes the golden blobs.
# usage: portable.sh PORTABLE_DECODER GOLDEN_BLOBS
set -eu

decoder=$1
goldens=$2

calls='open|openat|creat|fopen|freopen|mmap|munmap|shm_open|pthread_[a-z_]*|thrd_[a-z]*|sem_[a-z]*'
calls="$calls|clock|clock_gettime|gettimeofday|time|nanosleep|usleep|sleep|getenv|secure_getenv"
calls="$calls|setenv|socket|connect|fork|vfork|exec[a-z]*|posix_spawn|system|popen|kill|signal"
calls="$calls|sigaction|syscall|getpid|getrandom|rand|random|dlopen|stat|fstat|readdir|opendir"
if nm -D --undefined-only "$decoder" | sed 's/@.*//' | grep -wE "U ($calls)"; then
  echo "the decoder calls the operating system"
  exit 1
fi
if nm -DC --undefined-only "$decoder" |
  grep -E 'std::(thread|mutex|condition_variable|chrono|filesystem|random_device|basic_[io]?fstream)'; then
  echo "the decoder uses what needs an operating system"
  exit 1
fi
if nm -C "$decoder" | grep -E 'CGAL::Triangulation_3|Delaunay_triangulation_3' | head -n 3 | grep .; then
  echo "the decoder contains CGAL's tetrahedralization"
  exit 1
fi

# Only the standard libraries of C and C++ are allowed, and GMP, which needs no operating system.
if readelf -d "$decoder" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' |
  grep -vE '^(libgmp|libstdc\+\+|libm|libgcc_s|libc|ld-linux[a-z0-9_-]*)\.so'; then
  echo "the decoder needs another library"
  exit 1
fi

decoded=0
declined=0
for blob in "$goldens"/version-1/*.blob; do
  status=0
  reason=$("$decoder" <"$blob") || status=$?
  case $status in
    0) decoded=$((decoded + 1)) ;;
    *)
      case $reason in
        *"only CGAL takes"*) declined=$((declined + 1)) ;;
        *) echo "$blob: $reason" && exit 1 ;;
      esac
      ;;
  esac
done
echo "$decoded golden blobs decoded, $declined declined: their coordinates are not whole"
[ "$decoded" -ge 26 ] && [ "$declined" -le 2 ]
