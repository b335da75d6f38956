// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arguments of commands, for the files of the program `watertight` that describe them to CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "cli/commands.h"

namespace watertight::cli {

/// The command that was chosen; set by CLI11's callbacks.
using Chosen = std::function<Exit()>;

/// Adds the options that name a store.
void add_store(CLI::App& app, StoreChoice& store);
/// Requires a store. CLI11's require_option does not do, as a URL may come from the environment.
void require_store(const StoreChoice& store);

/// Like CLI::Range, but refuses "nan", which CLI::Range accepts as in range.
CLI::Validator in_range(double min, double max, const std::string& words);

/// Adds the list of remedies by this name, and the distance of weld.
CLI::Option* add_remedies(CLI::App& sub, const std::string& name, std::string& remedies,
                          double& weld_metres);
/// Adds the options of the remedy `smooth`.
void add_smooth(CLI::App& sub, RepairCommand& command);

/// Add the commands of the service.
void add_serve(CLI::App& app, ServeCommand& command, Chosen& chosen);
void add_key(CLI::App& app, KeyCommand& command, Chosen& chosen);

}  // namespace watertight::cli
