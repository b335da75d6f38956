// SPDX-License-Identifier: GPL-3.0-or-later
//
// The one function behind the engine executables. Each executable links exactly one
// implementation; no library does. Engines may crash, hang or throw on any input: that is why they
// live in processes of their own.
#pragma once

#include "delaunay/cdt_frames.h"

namespace watertight::delaunay {

/// Guarantees nothing: the ladder checks every answer with its certificate. May throw whatever the
/// engine throws; the process is replaced then.
CdtAnswer constrained_delaunay(const CdtJob& job);

/// Bytes of a job to bytes of an answer, for serve_jobs().
Bytes answer_job(ByteView request);

}  // namespace watertight::delaunay
