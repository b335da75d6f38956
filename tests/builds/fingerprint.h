// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parts of a build's fingerprint. Each prints lines that must be the same in every build; those
// that return a value return false if something did not work at all.
#pragma once

#include <span>

namespace watertight::builds {

void print_blob_hashes();
bool print_meshes();
/// Verdict, report and blob of every solid of the documents.
bool print_documents(std::span<char* const> files);
/// Prints nothing: starts a server and lets clients come and go.
bool serve_leaving_clients();

}  // namespace watertight::builds
