// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/engines/engine.h"

namespace watertight {

Bytes answer_job(ByteView request) {
  const Result<CdtJob> job = read_job(request);
  if (!job) return write_answer(CdtAnswer{{}, to_string(job.error())});
  return write_answer(constrained_delaunay(*job));
}

}  // namespace watertight
