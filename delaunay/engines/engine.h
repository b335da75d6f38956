// SPDX-License-Identifier: GPL-3.0-or-later
//
// The one function behind the engine executables. Each executable links exactly one
// implementation; no library does. Engines may crash, hang or throw on any input: that is why they
// live in processes of their own.
#pragma once

#include "delaunay/cdt_frames.h"

namespace watertight::delaunay {

/// Makes a constrained Delaunay tetrahedralization. Guarantees nothing: the ladder checks every
/// answer by a certificate. May throw whatever the engine throws; the process is replaced then.
CdtAnswer constrained_delaunay(const CdtJob& job);

/// Makes the bytes of an answer from the bytes of a job, for serve_jobs().
Bytes answer_job(ByteView request);

}  // namespace watertight::delaunay
