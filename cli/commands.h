// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands behind `watertight COMMAND`, as functions of their options. Results go to standard
// output, messages to standard error.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "cli/rules.h"
#include "cli/summary.h"
#include "files/files.h"
#include "pipeline/pipeline.h"
#include "tiles/glb.h"

namespace watertight::cli {

struct ValidateCommand {
  std::vector<std::string> files;
  std::string report;                        // file for the JSON report, "" for none
  std::string geojson;                       // file for a layer of the findings, "" for none
  std::string html;                          // file for an HTML page, "" for none
  std::string csv;                           // file for a table of the findings, "" for none
  std::string sarif;                         // file for a SARIF log, "" for none
  std::string baseline;                      // an earlier JSON report, "" for none
  std::string explain;                       // a code to explain instead of validating, "" for none
  std::vector<std::string> interior_shells;  // files with cavities of the document's only solid
  RuleChoice rules;
  std::string surfaces = "check";       // "ignore", "check", "judge" or "as-solids"
  double chord = formats::kUsualChord;  // metres, for curved solids
  std::optional<int> lattice_exponent;  // of a metre, for curved solids
  std::string strips;                   // file for the strips of curved solids, "" for none
  std::string output;                   // file for the document as it was read, "" for none
  double seconds_per_solid = 0;  // the time that engines may take; 0: by the size of the solid
  std::string engine = "auto";   // "auto", "cgal" or "tetgen"
  std::optional<double> tolerant_metres;  // the snap distance of a tolerant verdict as well
  bool leaves_times_out = false;
  bool is_quiet = false;         // no line per finding
  bool requires_solids = false;  // a file without solids is status 1
  std::size_t jobs = 1;
  std::string program_version;
};
Exit run(const ValidateCommand& command);

struct EncodeCommand {
  std::vector<std::string> files;
  std::string input;   // the name of the document in work
  std::string output;  // a folder for several documents
  std::string mode = "auto";
  bool keeps_steiner = false;
  std::string contract = "exact";
  std::string invalid = "keep";
  std::string rejected;  // file for what --invalid skip leaves out, "" for none
  RuleChoice rules;
  std::string surfaces = "ignore";      // or "as-solids"
  double chord = formats::kUsualChord;  // metres, for curved solids
  std::string purpose = "size";         // or "ranges"
  bool is_bare = false;                 // one blob instead of a Watertight file
  bool explains = false;                // print the bytes that the solids take in each mode
  std::size_t jobs = 1;
};
/// Encodes all documents; several go to a folder, each to a file of its own.
Exit run(const EncodeCommand& command);
/// Encodes one document, `source`, which messages call `command.input`, to `command.output`.
/// `position`: which document of how many, for the progress bar.
Exit encode_input(const EncodeCommand& command, const files::InputFile& source,
                  const std::string& position);

/// A document that was validated and encoded; none if it was refused or could not be read, which
/// was reported then.
struct EncodedInput {
  Exit exit = Exit::valid;
  std::optional<pipeline::EncodedDocument> document;
};
EncodedInput encode_one(const EncodeCommand& command, const files::InputFile& source,
                        const std::string& position);

struct AppendCommand {
  std::string target;
  EncodeCommand encode;  // of the documents; purpose is that of the new blocks
};
Exit run(const AppendCommand& command);

struct DeleteCommand {
  std::string target;
  std::vector<std::string> ids;
};
Exit run(const DeleteCommand& command);

struct DecodeCommand {
  std::string input;
  std::string output;
  std::size_t jobs = 1;
};
Exit run(const DecodeCommand& command);

/// Some features of a Watertight file.
struct GetCommand {
  std::string input;  // file or URL
  std::vector<std::string> ids;
  std::vector<double> box;  // 4 or 6 numbers, none for ids
  std::string output = "-";
};
Exit run(const GetCommand& command);

struct InfoCommand {
  std::string input;
  bool lists_blocks = false;
  bool is_json = false;
};
Exit run(const InfoCommand& command);

struct ConvertCommand {
  std::string input;
  std::string output;
  std::string surfaces = "ignore";      // or "as-solids"
  double chord = formats::kUsualChord;  // metres, for curved solids
};
Exit run(const ConvertCommand& command);

struct RepairCommand {
  std::string input;
  std::string output;
  std::string remedies = "rings,orientation,junctions";  // or "all"
  double weld_metres = 0;
  std::size_t most_islands = 4;
  repair::SmoothOptions smooth;
  std::string spline;  // file for the surfaces of smooth patches, "" for none
  std::string report;  // file for the JSON report, "" for none
  std::string html;    // file for an HTML page, "" for none
  bool leaves_times_out = false;
  RuleChoice rules;
  std::string surfaces = "ignore";      // or "as-solids"
  double chord = formats::kUsualChord;  // metres, for curved solids
  bool is_quiet = false;
  std::size_t jobs = 1;
  std::string program_version;
};
Exit run(const RepairCommand& command);

struct TilesCommand {
  std::vector<std::string> files;
  std::string output;  // a folder that is not there yet
  std::string lod;     // "" for the highest of each object
  tiles::Compression compression = tiles::Compression::meshopt;
  std::size_t jobs = 1;
};
Exit run(const TilesCommand& command);

struct AdviseCommand {
  std::string input;
  RuleChoice rules;
  std::size_t jobs = 1;
};
Exit run(const AdviseCommand& command);

/// The choice of the store for the solids.
struct StoreChoice {
  std::string data_directory;
  std::string database_url;
};

struct ServeCommand {
  StoreChoice store;
  std::string listen = "127.0.0.1:8080";
  std::string probes;           // "" for no address of their own
  std::string base_url;         // the start of links, "" for what requests say
  std::string tls_certificate;  // a file; "": clients speak plain HTTP
  std::string tls_key;          // a file
  std::string cors;             // whose web pages may read, "" for none but the service's own
  std::optional<std::size_t> connections_per_address;
  bool requires_preconditions = false;
  std::string jobs_folder;         // "" for that in the data directory, if there is one
  std::string keys_file;           // "" for none
  std::string user_field;          // of requests with a key, "" for none
  bool is_open = false;            // nobody needs a key, though other machines reach the address
  bool reading_is_public = false;  // with keys_file
  bool prints_options = false;     // and does nothing else
};
Exit run(const ServeCommand& command);

struct RowsCommand {
  std::vector<std::string> files;
  std::string surfaces = "ignore";      // or "as-solids"
  double chord = formats::kUsualChord;  // metres, for curved solids
};
/// Writes the solids of documents as rows for COPY to standard output.
Exit run(const RowsCommand& command);

struct KeyCommand {
  std::string name;
  std::string scope;
  std::string file;
};
/// Makes an access key, adds its digest to a file and prints it.
Exit run(const KeyCommand& command);

struct IngestCommand {
  StoreChoice store;
  std::vector<std::string> files;
  std::string collection;
  std::string invalid;   // "" for the policy of the collection
  std::string rejected;  // file for what --invalid skip leaves out, "" for none
  std::string remedies;  // that repair what is not valid before it is stored, "" for none
  double weld_metres = 0;
  RuleChoice rules;
  std::string surfaces = "ignore";      // or "as-solids"
  double chord = formats::kUsualChord;  // metres, for curved solids
  std::string contract = "exact";
  bool is_json = false;
  bool is_quiet = false;
  std::size_t jobs = 1;
};
Exit run(const IngestCommand& command);

struct ExportCommand {
  StoreChoice store;
  std::string collection;
  std::string output;
  std::string purpose = "size";  // of a Watertight file, or "ranges"
  bool is_proven_only = false;
  std::vector<std::string> where;  // NAME=VALUE
  std::string lod;                 // of a GeoPackage; "": the highest of each object
};
Exit run(const ExportCommand& command);

struct CompactCommand {
  StoreChoice store;
  std::string collection;
};
/// Packs the features of a collection again (pipeline/stored/compact.h).
Exit run(const CompactCommand& command);

struct CollectionsCommand {
  enum class Action : std::uint8_t {
    list,
    info,
    policy,
    rules,
    remove,
    rename,
    recount,
    attributes
  };
  StoreChoice store;
  Action action = Action::list;
  std::string id;
  std::string new_id;                       // of rename
  std::string policy;                       // of policy
  std::vector<std::string> rules;           // of rules: NAME=VALUE; none: no rules
  bool is_json = false;                     // of list, info, recount and attributes
  std::vector<std::string> added, removed;  // of attributes
  bool is_found = false;                    // of attributes: those that there are
};
Exit run(const CollectionsCommand& command);

/// "watertight: <file>: <what> (at <place>)" on standard error.
void complain(const std::string& file, const Error& error);

/// Complains; the exit status of a command that could not do its work.
Exit fail(const std::string& file, const Error& error);

/// The same for a file that could not be written, which may be standard output ("-").
Exit fail_to_write(const std::string& file, const Error& error);

/// The findings of a feature's solids and groups, as lines.
void print_findings(const std::string& file, const pipeline::FeatureOutcome& feature,
                    std::FILE* out = stdout);

}  // namespace watertight::cli
