// SPDX-License-Identifier: GPL-3.0-or-later
//
// `watertight COMMAND ...`: reads the command line and runs the command (docs/cli.md).
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <thread>

#include "cli/arguments/arguments.h"
#include "pipeline/pipeline.h"

namespace watertight::cli {
namespace {

std::size_t default_jobs() {
  return std::max(1U, std::min(std::thread::hardware_concurrency(), 64U));
}

void add_jobs(CLI::App& app, std::size_t& jobs,
              const std::string& words = "features validated at once") {
  jobs = default_jobs();
  app.add_option("-j,--jobs", jobs, words)->check(CLI::Range(1, 256))->capture_default_str();
}

/// Adds the rules by which solids are judged.
void add_rules(CLI::App& sub, RuleChoice& rules) {
  sub.add_option("--planarity", rules.planarity_metres, "largest distance from a plane, metres")
      ->check(in_range(1e-9, 1000, "from 1e-9 to 1000"))
      ->default_str("0.01");
  sub.add_option("--planarity-angle", rules.planarity_degrees,
                 "largest angle within a facet, degrees")
      ->check(in_range(1e-6, 90, "from 1e-6 to 90"))
      ->default_str("20");
  sub.add_option("--proof", rules.proof, "proof of validity")
      ->check(CLI::IsMember({"tetrahedralization", "boundary"}))
      ->default_str("tetrahedralization");
  sub.add_option(
         "--overlap", rules.overlap_metres,
         "depth to which building parts, composite members and indoor cells may overlap, and gap "
         "between neighbouring cells, metres")
      ->check(in_range(0, 1000, "from 0 to 1000"))
      ->default_str("0");
  sub.add_flag("--exact-overlaps", rules.are_steps_errors,
               "overlaps no deeper than a step of the coordinates are errors, not warnings");
  sub.add_flag("--strict", rules.is_strict, "only the canonical triangles of facets count");
}

/// Adds the choice between surfaces as they came and closed surfaces as solids.
void add_surfaces(CLI::App& sub, std::string& surfaces) {
  sub.add_option("--surfaces", surfaces,
                 "MultiSurfaces and CompositeSurfaces: ignore, they stay as they came; as-solids, "
                 "closed ones are solids")
      ->check(CLI::IsMember({"ignore", "as-solids"}))
      ->capture_default_str();
}

/// Adds how near the triangles of curved solids are to their surfaces.
CLI::Option* add_chord(CLI::App& sub, double& chord) {
  return sub
      .add_option("--chord", chord,
                  "largest distance of triangles from the surfaces of curved solids, metres")
      ->check(in_range(1e-9, 1000, "from 1e-9 to 1000"))
      ->type_name("M")
      ->capture_default_str();
}

void add_lattice(CLI::App& sub, std::optional<int>& exponent) {
  sub.add_option_function<std::string>(
         "--lattice",
         [&exponent](const std::string& text) {
           const auto read = pipeline::lattice_exponent_of(text);
           if (!read) throw CLI::ValidationError("--lattice", read.error().message);
           exponent = *read;
         },
         "step of the lattice of vertices, metres, a power of ten; default: the largest that is "
         "not above a hundredth of the chord")
      ->type_name("M");
}

void add_validate(CLI::App& app, ValidateCommand& command, Chosen& chosen) {
  CLI::App* sub =
      app.add_subcommand("validate", "Report which solids are valid, and why others are not");
  sub->add_option("FILE", command.files,
                  "documents, also in folders, zip archives and compressed files; - for standard "
                  "input");
  sub->add_option("--report", command.report, "write the reports as JSON, a line per document");
  sub->add_option("--geojson", command.geojson, "write the findings as a GeoJSON layer");
  sub->add_option("--html", command.html, "write the report as a page with pictures");
  sub->add_option("--csv", command.csv, "write the findings as a table, a row for each");
  sub->add_option("--sarif", command.sarif, "write the findings as SARIF 2.1.0, for code hosts");
  sub->add_option("--baseline", command.baseline,
                  "an earlier --report: only findings that it does not have give status 1");
  sub->add_option("--explain", command.explain,
                  "print what a finding means, its cause and its remedy, for a code or a name");
  sub->add_flag("--require-solids", command.requires_solids, "status 1 for a file without solids");
  sub->add_option("--surfaces", command.surfaces,
                  "MultiSurfaces and CompositeSurfaces: ignore them; check rings and facets, "
                  "findings are warnings; judge them, findings are errors; as-solids, closed ones "
                  "are solids")
      ->check(CLI::IsMember({"ignore", "check", "judge", "as-solids"}))
      ->capture_default_str();
  add_chord(*sub, command.chord);
  sub->add_option("--interior-shell", command.interior_shells,
                  "file with a cavity of the file's one solid; can be repeated")
      ->allow_extra_args(false);
  sub->add_option("--seconds", command.seconds_per_solid,
                  "CPU time of engines for a solid; 0: by its size")
      ->check(in_range(0, 86400, "from 0 to 86400"))
      ->capture_default_str();
  sub->add_option("--tolerant", command.tolerant_metres,
                  "also report the verdict on the solid with vertices snapped within M metres; "
                  "val3dity has 0.001")
      ->check(in_range(1e-9, 1000, "from 1e-9 to 1000"))
      ->type_name("M");
  sub->add_flag("--no-times", command.leaves_times_out,
                "reports without times: same input, same bytes");
  add_rules(*sub, command.rules);
  sub->add_option("--engine", command.engine, "engine that is asked first for tetrahedralizations")
      ->check(CLI::IsMember({"auto", "cgal", "tetgen"}))
      ->capture_default_str();
  sub->add_flag("-q,--quiet", command.is_quiet, "the summary and the table only");
  add_jobs(*sub, command.jobs);
  command.program_version = WATERTIGHT_VERSION;
  sub->callback([&] {
    if (command.files.empty() == command.explain.empty()) {
      throw CLI::ValidationError("either FILE or --explain CODE is required");
    }
    chosen = [&] { return run(command); };
  });
}

void add_tessellate(CLI::App& app, ValidateCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand(
      "tessellate",
      "Write curved solids (IFC, STEP, BRep, patches) as polyhedra, and report which are valid");
  sub->add_option("IN", command.files, "document; - for standard input")->required()->expected(1);
  sub->add_option("-o,--output", command.output, "its extension decides the format")->required();
  add_chord(*sub, command.chord);
  add_lattice(*sub, command.lattice_exponent);
  sub->add_option("--strips", command.strips, "write the triangles as strips, JSON");
  sub->add_option("--report", command.report, "write the report as JSON");
  sub->add_option("--html", command.html, "write the report as a page with pictures");
  sub->add_flag("--no-times", command.leaves_times_out,
                "reports without times: same input, same bytes");
  add_rules(*sub, command.rules);
  sub->add_flag("-q,--quiet", command.is_quiet, "the summary and the table only");
  add_jobs(*sub, command.jobs);
  command.program_version = WATERTIGHT_VERSION;
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_advise(CLI::App& app, AdviseCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand(
      "advise", "Find the fewest decimals at which every valid solid of a document stays valid");
  sub->add_option("FILE", command.input, "document; - for standard input")->required();
  add_rules(*sub, command.rules);
  add_jobs(*sub, command.jobs);
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_contract(CLI::App& sub, std::string& contract) {
  sub.add_option(
         "--contract", contract,
         "content that comes back: exact, the very bytes; lattice, the same values in canonical "
         "order; boundary, the solids only")
      ->check(CLI::IsMember({"exact", "lattice", "boundary"}))
      ->capture_default_str();
}

void add_purpose(CLI::App& sub, std::string& purpose) {
  sub.add_option(
         "--for", purpose,
         "size, a Watertight file that is as small as it can be; ranges, one whose features "
         "are read one by one, from a web server too")
      ->check(CLI::IsMember({"size", "ranges"}))
      ->capture_default_str();
}

void add_encode(CLI::App& app, EncodeCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("encode", "Validate and compress a document");
  sub->add_option("IN", command.files,
                  "documents, also in folders, zip archives and compressed files; - for standard "
                  "input")
      ->required();
  sub->add_option("-o,--output", command.output,
                  "Watertight file; - for standard output; a folder for several documents")
      ->required();
  auto* mode =
      sub->add_option("--mode", command.mode, "how solids are coded")
          ->check(CLI::IsMember({"auto", "raw", "bitmap", "walk", "polygon", "parallelogram"}))
          ->capture_default_str();
  sub->add_flag("--steiner", command.keeps_steiner,
                "keep the Steiner vertices of the proof (mode bitmap)")
      ->excludes(mode);
  sub->add_option("--invalid", command.invalid,
                  "what is not proven to be valid: keep, as it came and marked as unproven; skip, "
                  "leave it out; refuse, write nothing")
      ->check(CLI::IsMember({"keep", "skip", "refuse"}))
      ->capture_default_str();
  sub->add_option("--rejected", command.rejected,
                  "with --invalid skip: write what is left out to this CityJSON file, and the "
                  "findings to FILE.report.json");
  add_rules(*sub, command.rules);
  add_surfaces(*sub, command.surfaces);
  add_chord(*sub, command.chord);
  add_purpose(*sub, command.purpose);
  sub->add_flag("--bare", command.is_bare, "write the one solid's blob, without its document");
  add_contract(*sub, command.contract);
  sub->add_flag("--explain", command.explains,
                "print the bytes that the solids take in each mode, part by part");
  add_jobs(*sub, command.jobs);
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_append(CLI::App& app, AppendCommand& command, Chosen& chosen) {
  CLI::App* sub =
      app.add_subcommand("append", "Add the features of documents to a Watertight file");
  EncodeCommand& encode = command.encode;
  encode.purpose = "ranges";
  sub->add_option("FILE", command.target, "Watertight file")->required();
  sub->add_option("DOCUMENT", encode.files,
                  "documents; a feature replaces the one with the same id in FILE")
      ->required();
  sub->add_option("--invalid", encode.invalid,
                  "what is not proven to be valid: keep, as it came and marked as unproven; skip, "
                  "leave it out; refuse, write nothing")
      ->check(CLI::IsMember({"keep", "skip", "refuse"}))
      ->capture_default_str();
  add_rules(*sub, encode.rules);
  add_surfaces(*sub, encode.surfaces);
  add_chord(*sub, encode.chord);
  add_contract(*sub, encode.contract);
  add_jobs(*sub, encode.jobs);
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_delete(CLI::App& app, DeleteCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("delete", "Delete features of a Watertight file");
  sub->add_option("FILE", command.target, "Watertight file")->required();
  sub->add_option("ID", command.ids, "ids of features")->required();
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_decode(CLI::App& app, DecodeCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("decode", "Restore the document of a Watertight file or blob");
  sub->add_option("IN", command.input, "Watertight file, its URL, or blob; - for standard input")
      ->required();
  sub->add_option("-o,--output", command.output,
                  "its extension decides the format; - for standard output in the stored format")
      ->required();
  add_jobs(*sub, command.jobs, "blocks of a file read at once");
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_get(CLI::App& app, GetCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("get", "Write some features of a Watertight file");
  sub->add_option("FILE", command.input,
                  "Watertight file, of which only the parts with these features are read; also a "
                  "http or https URL")
      ->required();
  auto* ids = sub->add_option("ID", command.ids, "ids of features, or of city objects in them");
  sub->add_option("--bbox", command.box,
                  "features whose boxes meet this one: minx,miny,maxx,maxy or "
                  "minx,miny,minz,maxx,maxy,maxz")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes(ids);
  sub->add_option("-o,--output", command.output,
                  "its extension decides the format; - for standard output as CityJSONSeq")
      ->capture_default_str();
  sub->callback([&] {
    if (command.ids.empty() == command.box.empty()) {
      throw CLI::ValidationError("either IDs or --bbox are required");
    }
    chosen = [&] { return run(command); };
  });
}

void add_convert(CLI::App& app, ConvertCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("convert", "Write a document in another format, unvalidated");
  sub->add_option("IN", command.input, "document; - for standard input")->required();
  sub->add_option("-o,--output", command.output, "its extension decides the format")->required();
  add_surfaces(*sub, command.surfaces);
  add_chord(*sub, command.chord);
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_repair(CLI::App& app, RepairCommand& command, Chosen& chosen) {
  CLI::App* sub =
      app.add_subcommand("repair", "Make invalid solids valid by the least change, and prove it");
  sub->add_option("IN", command.input, "document; - for standard input")->required();
  sub->add_option("-o,--output", command.output, "its extension decides the format")->required();
  add_remedies(*sub, "--remedies", command.remedies, command.weld_metres)->capture_default_str();
  sub->add_option("--report", command.report,
                  "write the report on the repaired document, with what was done, as JSON");
  sub->add_option("--html", command.html, "write that report as a page with pictures");
  sub->add_flag("--no-times", command.leaves_times_out,
                "reports without times: same input, same bytes");
  sub->add_option("--islands", command.most_islands,
                  "most islands of a hole for which fill looks for the best triangles")
      ->check(in_range(0, 5, "from 0 to 5"))
      ->capture_default_str();
  add_smooth(*sub, command);
  add_rules(*sub, command.rules);
  add_surfaces(*sub, command.surfaces);
  const CLI::Option* chord = add_chord(*sub, command.chord);
  sub->add_flag("-q,--quiet", command.is_quiet, "the table only");
  add_jobs(*sub, command.jobs, "solids repaired at once");
  command.program_version = WATERTIGHT_VERSION;
  sub->callback([&, chord] {
    if (chord->count() > 0) command.smooth.chord_metres = command.chord;
    chosen = [&] { return run(command); };
  });
}

void add_tiles(CLI::App& app, TilesCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand(
      "tiles", "Write documents as a tileset of 3D Tiles 1.1 for web maps, unvalidated");
  sub->add_option("FILE", command.files,
                  "documents, also in folders, zip archives and compressed files; one tileset of "
                  "all")
      ->required();
  sub->add_option("-o,--output", command.output, "a new folder for tileset.json and the tiles")
      ->required();
  sub->add_option("--lod", command.lod,
                  "only geometries of this level of detail; default: the highest of each object");
  sub->add_flag_callback(
      "--uncompressed", [&] { command.compression = tiles::Compression::none; },
      "without EXT_meshopt_compression, for programs that cannot read it");
  add_jobs(*sub, command.jobs, "features triangulated at once");
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_info(CLI::App& app, InfoCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("info", "Describe a blob or a Watertight file");
  sub->add_option("BLOB", command.input, "file or URL; - for standard input")->required();
  sub->add_flag("--blocks", command.lists_blocks, "also each block of a Watertight file");
  sub->add_flag("--json", command.is_json, "as one line of JSON");
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

std::string is_collection_id(const std::string& id) {
  const Status checked = store::check_collection_id(id);
  return checked ? std::string() : checked.error().message;
}

void add_ingest(CLI::App& app, IngestCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("ingest", "Validate documents and store them");
  sub->add_option("FILE", command.files,
                  "documents, also in folders, zip archives and compressed files; each is stored "
                  "whole or not at all")
      ->required();
  sub->add_option("--collection", command.collection, "collection, made when missing")
      ->required()
      ->check(is_collection_id);
  add_store(*sub, command.store);
  sub->add_option("--invalid", command.invalid,
                  "documents with invalid features: refuse them, skip those features, or keep what "
                  "is not proven as it came; default: the policy of the collection, refuse for a "
                  "new one")
      ->check(CLI::IsMember({"refuse", "skip", "keep"}));
  sub->add_option("--rejected", command.rejected,
                  "a CityJSONSeq for what --invalid skip leaves out; the findings go to FILE "
                  "with .report.json");
  CLI::Option* repair = add_remedies(*sub, "--repair", command.remedies, command.weld_metres);
  sub->get_option("--weld")->needs(repair);
  add_rules(*sub, command.rules);
  add_surfaces(*sub, command.surfaces);
  add_chord(*sub, command.chord);
  add_contract(*sub, command.contract);
  sub->add_flag("--json", command.is_json, "the table as one line of JSON");
  sub->add_flag("-q,--quiet", command.is_quiet, "the table only");
  add_jobs(*sub, command.jobs);
  sub->callback([&] {
    require_store(command.store);
    chosen = [&] { return run(command); };
  });
}

void add_rows(CLI::App& app, RowsCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand(
      "rows", "Write the solids of documents as rows for PostgreSQL's COPY, unvalidated");
  sub->add_option("FILE", command.files, "documents, also in folders, archives and compressed")
      ->required();
  add_surfaces(*sub, command.surfaces);
  add_chord(*sub, command.chord);
  sub->callback([&] { chosen = [&] { return run(command); }; });
}

void add_export(CLI::App& app, ExportCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand("export", "Write a collection of a store to a file");
  sub->add_option("COLLECTION", command.collection, "collection")->required();
  sub->add_option(
         "-o,--output", command.output,
         "Watertight file (.wt, or - for standard output), CityJSONSeq (.jsonl; OUT-2, ... if "
         "the documents have headers that cannot be merged) or GeoPackage (.gpkg)")
      ->required();
  add_purpose(*sub, command.purpose);
  sub->add_flag("--proven", command.is_proven_only,
                "only features whose solids are all proven to be valid");
  sub->add_option("--where", command.where,
                  "only features with this value of an attribute that the collection has chosen "
                  "(again: all must hold)")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  sub->add_option("--lod", command.lod, "the level of detail in a GeoPackage; else the highest");
  add_store(*sub, command.store);
  sub->callback([&] {
    require_store(command.store);
    chosen = [&] { return run(command); };
  });
}

/// Raises the number of files that may be open to what the system allows this process.
void allow_many_files() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);  // a failure leaves the limit as it was
}

/// Adds the action `name` to the command collections. Options of the command may follow it.
CLI::App* add_action(CLI::App& collections, const std::string& name, const std::string& help,
                     CollectionsCommand& command, CollectionsCommand::Action action) {
  CLI::App* sub = collections.add_subcommand(name, help)->fallthrough();
  sub->callback([&command, action] { command.action = action; });
  if (action == CollectionsCommand::Action::list) return sub;
  sub->add_option("ID", command.id, "collection")->required()->check(is_collection_id);
  return sub;
}

void add_collections(CLI::App& app, CollectionsCommand& command, Chosen& chosen) {
  using Action = CollectionsCommand::Action;
  CLI::App* sub = app.add_subcommand("collections",
                                     "List, show, delete, rename or count collections of a store, "
                                     "choose their attributes");
  sub->require_subcommand(1);
  add_store(*sub, command.store);
  CLI::App* list =
      add_action(*sub, "list", "Print a line for each collection", command, Action::list);
  CLI::App* info =
      add_action(*sub, "info", "Print the line of one collection", command, Action::info);
  add_action(*sub, "policy", "Set what becomes of features that are not valid", command,
             Action::policy)
      ->add_option("POLICY", command.policy,
                   "refuse their documents, skip them, or keep them as they came")
      ->required()
      ->check(CLI::IsMember({"refuse", "skip", "keep"}));
  add_action(*sub, "rules",
             "Set the rules by which later writes judge solids: these and no others, so without "
             "any the usual ones",
             command, Action::rules)
      ->add_option("RULE", command.rules, "NAME=VALUE, as planarity=0.02 or proof=boundary");
  add_action(*sub, "delete", "Delete a collection with all its features", command, Action::remove);
  add_action(*sub, "rename", "Give a collection another id", command, Action::rename)
      ->add_option("NEW", command.new_id, "the new id")
      ->required()
      ->check(is_collection_id);
  CLI::App* recount = add_action(*sub, "recount", "Count the features again, print the line",
                                 command, Action::recount);
  CLI::App* attributes =
      add_action(*sub, "attributes", "Choose attributes that can be queried, print the chosen ones",
                 command, Action::attributes);
  attributes->add_option("--add", command.added, "choose this attribute; keeps its values")
      ->type_name("NAME")
      ->allow_extra_args(false);
  attributes->add_option("--remove", command.removed, "do not choose it any more")
      ->type_name("NAME")
      ->allow_extra_args(false);
  attributes->add_flag("--found", command.is_found,
                       "print all attributes of the features, with the number of their values");
  for (CLI::App* action : {list, info, recount, attributes}) {
    action->add_flag("--json", command.is_json, "a line of JSON for each collection or attribute");
  }
  sub->callback([&] {
    require_store(command.store);
    chosen = [&] { return run(command); };
  });
}

void add_compact(CLI::App& app, CompactCommand& command, Chosen& chosen) {
  CLI::App* sub = app.add_subcommand(
      "compact", "Pack the features of a collection again, with a dictionary made from them");
  sub->add_option("COLLECTION", command.collection, "collection")
      ->required()
      ->check(is_collection_id);
  add_store(*sub, command.store);
  sub->callback([&] {
    require_store(command.store);
    chosen = [&] { return run(command); };
  });
}

int run_command_line(int argc, char** argv) {
  allow_many_files();
  CLI::App app("Validates, stores and compresses 3D solids", "watertight");
  app.set_version_flag("--version", WATERTIGHT_VERSION);
  app.require_subcommand(1);
  app.set_config("--config", "", "file of options (TOML), in a section for each command")
      ->configurable(false);
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.footer(
      "Exit status: 0 all valid (warnings allowed), 1 something invalid, 2 error, 3 undecided");
  ValidateCommand validate_command;
  ValidateCommand tessellate_command;
  AdviseCommand advise_command;
  EncodeCommand encode_command;
  DecodeCommand decode_command;
  InfoCommand info_command;
  ConvertCommand convert_command;
  RepairCommand repair_command;
  RowsCommand rows_command;
  TilesCommand tiles_command;
  GetCommand get_command;
  AppendCommand append_command;
  DeleteCommand delete_command;
  ServeCommand serve_command;
  KeyCommand key_command;
  IngestCommand ingest_command;
  ExportCommand export_command;
  CollectionsCommand collections_command;
  CompactCommand compact_command;
  Chosen chosen;
  add_validate(app, validate_command, chosen);
  add_tessellate(app, tessellate_command, chosen);
  add_advise(app, advise_command, chosen);
  add_encode(app, encode_command, chosen);
  add_decode(app, decode_command, chosen);
  add_get(app, get_command, chosen);
  add_append(app, append_command, chosen);
  add_delete(app, delete_command, chosen);
  add_tiles(app, tiles_command, chosen);
  add_info(app, info_command, chosen);
  add_convert(app, convert_command, chosen);
  add_repair(app, repair_command, chosen);
  add_rows(app, rows_command, chosen);
  add_serve(app, serve_command, chosen);
  add_key(app, key_command, chosen);
  add_ingest(app, ingest_command, chosen);
  add_export(app, export_command, chosen);
  add_collections(app, collections_command, chosen);
  add_compact(app, compact_command, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(Exit::error);
  }
  const Exit exit = chosen();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(exit);
  std::fputs("watertight: standard output could not be written\n", stderr);
  return static_cast<int>(Exit::error);
}

}  // namespace
}  // namespace watertight::cli

int main(int argc, char** argv) {
  try {
    return watertight::cli::run_command_line(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs("watertight: not enough memory\n", stderr);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "watertight: unexpected failure: %s\n", failure.what());
  }
  return static_cast<int>(watertight::cli::Exit::error);
}
