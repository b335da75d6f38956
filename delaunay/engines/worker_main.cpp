// SPDX-License-Identifier: GPL-3.0-or-later
//
// watertight-worker and watertight-tetgen: answer constrained Delaunay jobs on descriptor 3.
// Started by WorkerPool, of no use by hand.
#include "delaunay/engines/engine.h"
#include "workers/worker_pool.h"

int main() { return watertight::workers::serve_jobs(watertight::delaunay::answer_job); }
