// SPDX-License-Identifier: GPL-3.0-or-later
#include <time.h>

#include "delaunay/engines/engine.h"

namespace watertight::delaunay {
namespace {

/// CPU time of this thread in seconds; engines have no other thread. The clock of a process that
/// has a CPU limit is brought up to date at ticks only, which is too coarse for short jobs.
double cpu_seconds() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

}  // namespace

Bytes answer_job(ByteView request) {
  const Result<CdtJob> job = read_job(request);
  if (!job) return write_answer(CdtAnswer{{}, to_string(job.error())});
  const double start = cpu_seconds();
  CdtAnswer answer = constrained_delaunay(*job);
  answer.engine_seconds = cpu_seconds() - start;
  return write_answer(answer);
}

}  // namespace watertight::delaunay
