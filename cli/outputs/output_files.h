// SPDX-License-Identifier: GPL-3.0-or-later
//
// The output files of a command that gives up its rights before it knows what to write. A process
// that was started before keeps the rights; it opens OUT, OUT-2, OUT-3, ... and gives them their
// names, and does nothing else.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/result.h"
#include "files/files.h"

namespace watertight::cli {

class OutputFiles {
 public:
  /// The most files of one output.
  static constexpr std::size_t kMost = 1000;

  /// Starts to write the first file, with the rights that the program has now. `gives_up_rights`:
  /// the program will lose rights, so a process is started that keeps them while this object lives;
  /// call it before the first thread starts. Errors: those of FileWriter::open(); unavailable.
  static Result<OutputFiles> open(const std::string& output, bool gives_up_rights);
  OutputFiles(OutputFiles&&) noexcept;
  OutputFiles& operator=(OutputFiles&&) = delete;
  ~OutputFiles();  // files without commit() are gone

  /// Starts to write one more file, with the rights of open(). Errors: those of FileWriter::open();
  /// limit_exceeded.
  Status add();
  std::size_t size() const;
  /// The name of a file: OUT, OUT-2, ...; "standard output" for "-".
  std::string name(std::size_t number) const;
  Status write(std::size_t number, std::string_view text);
  /// Gives each file its name. Errors: unavailable, with the file's name; the files before it stay
  /// then, and the others are gone.
  Status commit();

 private:
  struct State;
  explicit OutputFiles(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace watertight::cli
