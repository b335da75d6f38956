// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parts of a build's fingerprint. Each part prints lines that must be the same in every build;
// a part that returns a value returns false if something did not work at all.
#pragma once

#include <span>

namespace watertight::builds {

void print_blob_hashes();
bool print_meshes();
/// Prints checksums of the fillings of random holes.
bool print_fillings();
/// Prints checksums of filled holes in surfaces over triangulations.
bool print_splines();
/// Prints the verdict and the hashes of report and blob of every solid of the documents.
bool print_documents(std::span<char* const> files);
/// Starts a server and lets clients come and go. Prints nothing.
bool serve_leaving_clients();

}  // namespace watertight::builds
