// SPDX-License-Identifier: GPL-3.0-or-later
//
// The commands collections (lists, shows, deletes, renames and counts the collections of a store,
// chooses their attributes) and compact.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "cli/commands.h"
#include "cli/opened_store.h"
#include "cli/terminal/printable.h"
#include "pipeline/collections/collection_rules.h"
#include "pipeline/pipeline.h"
#include "pipeline/stored/attributes.h"
#include "pipeline/stored/compact.h"

namespace watertight::cli {
namespace {

constexpr std::uint64_t kPage = 1000;

std::string crs_of(const store::StoredCollection& collection) {
  return collection.srid == 0 ? "no stated CRS" : "EPSG:" + std::to_string(collection.srid);
}

std::string json_of(const store::StoredCollection& collection) {
  nlohmann::ordered_json json{
      {"id", collection.id},
      {"features", collection.features},
      {"solids", collection.solids},
      {"blobBytes", collection.blob_bytes},
      {"unproven", {{"features", collection.unproven_features}, {"solids", collection.unproven}}},
      {"invalid", pipeline::to_string(collection.policy)},
      {"srid", collection.srid}};
  for (const auto& [name, value] : pipeline::rules_in(collection.rules)) {
    json["rules"][name] = value;
  }
  if (collection.box) {
    json["boxMin"] = collection.box->min;
    json["boxMax"] = collection.box->max;
  }
  return json.dump();
}

std::string unproven_text(const store::StoredCollection& collection) {
  if (collection.unproven_features == 0) return {};
  return ", " + quantity(collection.unproven_features, "feature") + " and " +
         quantity(collection.unproven, "solid") + " not proven";
}

std::string rules_of(const store::StoredCollection& collection) {
  std::string text;
  for (const auto& [name, value] : pipeline::rules_in(collection.rules)) {
    text.append(text.empty() ? ", rules: " : " ").append(name).append("=").append(value);
  }
  return text;
}

std::string line_of(const store::StoredCollection& collection) {
  return printable(collection.id) + ": " + quantity(collection.features, "feature") + ", " +
         quantity(collection.solids, "solid") + ", " + quantity(collection.blob_bytes, "byte") +
         " of blobs, " + crs_of(collection) + unproven_text(collection) +
         ", invalid features: " + std::string(pipeline::to_string(collection.policy)) +
         rules_of(collection);
}

void print(const CollectionsCommand& command, const store::StoredCollection& collection) {
  std::puts((command.is_json ? json_of(collection) : line_of(collection)).c_str());
}

Status list(const CollectionsCommand& command, SolidStore& store) {
  std::string after;
  do {
    auto page = store.collections(kPage, after);
    if (!page) return std::move(page).error();
    for (const store::StoredCollection& collection : page->collections) print(command, collection);
    after = std::move(page->next);
  } while (!after.empty());
  return Done{};
}

Status show(const CollectionsCommand& command, SolidStore& store) {
  const auto found = store.collection(command.id);
  if (!found) return found.error();
  print(command, *found);
  return Done{};
}

Status recount(const CollectionsCommand& command, SolidStore& store) {
  const auto counted = store.recount(command.id);
  if (!counted) return counted.error();
  print(command, *counted);
  return Done{};
}

constexpr const char* kTypes[] = {"numbers", "texts", "truth values"};

std::string line_of(const store::ChosenAttribute& attribute, bool is_json) {
  const bool has[] = {attribute.has_numbers, attribute.has_texts, attribute.has_truths};
  if (is_json) {
    nlohmann::ordered_json json{{"name", attribute.name}, {"complete", attribute.is_complete()}};
    json["types"] = nlohmann::ordered_json::array();
    for (std::size_t type = 0; type < std::size(kTypes); ++type) {
      if (has[type]) json["types"].push_back(kTypes[type]);
    }
    return json.dump();
  }
  std::string line = printable(attribute.name) + ":";
  std::string types;
  for (std::size_t type = 0; type < std::size(kTypes); ++type) {
    if (has[type]) types.append(types.empty() ? " " : ", ").append(kTypes[type]);
  }
  line += types.empty() ? " no values" : types;
  if (attribute.is_complete()) return line;
  return line + ", filled to " + std::to_string(static_cast<int>(attribute.share * 100)) +
         " % (--add goes on)";
}

std::string line_of(const std::string& name, const pipeline::AttributeCount& count, bool is_json) {
  if (is_json) {
    nlohmann::ordered_json json{{"name", name}};
    for (std::size_t type = 0; type < std::size(kTypes); ++type) {
      json[kTypes[type]] = count.by_type[type];
    }
    json["others"] = count.others;
    return json.dump();
  }
  std::string line = printable(name) + ":";
  std::string parts;
  for (std::size_t type = 0; type < std::size(kTypes); ++type) {
    if (count.by_type[type] == 0) continue;
    parts.append(parts.empty() ? " " : ", ").append(std::to_string(count.by_type[type]));
    parts.append(1, ' ').append(kTypes[type]);
  }
  if (count.others > 0) {
    parts.append(parts.empty() ? " " : ", ").append(std::to_string(count.others));
    parts.append(" others");
  }
  return line + parts;
}

Status print_found(const CollectionsCommand& command, SolidStore& store) {
  const server::StopSignals signals;
  const auto found =
      pipeline::found_attributes(store, command.id, [&signals] { return signals.is_requested(); });
  if (!found) return found.error();
  for (const auto& [name, count] : *found) {
    std::puts(line_of(name, count, command.is_json).c_str());
  }
  return Done{};
}

Status attributes(const CollectionsCommand& command, SolidStore& store) {
  if (!command.added.empty() || !command.removed.empty()) {
    const server::StopSignals signals;
    int percent = 0;
    const Status changed = store.change_attributes(
        command.id, {command.added, command.removed}, [&signals] { return signals.is_requested(); },
        [&percent](double share) {
          const int now = static_cast<int>(share * 10) * 10;
          if (now > percent) std::fprintf(stderr, "watertight: attributes: %d %%\n", now);
          percent = now;
        });
    if (!changed) return changed;
  }
  if (command.is_found) return print_found(command, store);
  const auto chosen = store.attributes(command.id);
  if (!chosen) return chosen.error();
  for (const store::ChosenAttribute& attribute : *chosen) {
    std::puts(line_of(attribute, command.is_json).c_str());
  }
  return Done{};
}

/// Sets the rules of a collection: those that are given, and no others.
Status set_rules(const CollectionsCommand& command, SolidStore& store) {
  pipeline::Rules rules;
  pipeline::IngestOptions checked;
  for (const std::string& text : command.rules) {
    const std::size_t sign = std::min(text.find('='), text.size());
    std::string name = text.substr(0, sign);
    std::string value = text.substr(std::min(sign + 1, text.size()));
    if (Status known = pipeline::apply_rule(name, value, checked); !known) return known;
    rules.emplace_back(std::move(name), std::move(value));
  }
  return store.set_rules(command.id, pipeline::rules_text(std::move(rules)));
}

Status act(const CollectionsCommand& command, SolidStore& store) {
  switch (command.action) {
    case CollectionsCommand::Action::list:
      return list(command, store);
    case CollectionsCommand::Action::info:
      return show(command, store);
    case CollectionsCommand::Action::policy:
      return store.set_policy(command.id, *pipeline::policy_named(command.policy));
    case CollectionsCommand::Action::rules:
      return set_rules(command, store);
    case CollectionsCommand::Action::remove:
      return store.remove_collection(command.id, [] { return false; });
    case CollectionsCommand::Action::rename:
      return store.rename_collection(command.id, command.new_id);
    case CollectionsCommand::Action::recount:
      return recount(command, store);
    case CollectionsCommand::Action::attributes:
      return attributes(command, store);
  }
  return Done{};
}

}  // namespace

Exit run(const CollectionsCommand& command) {
  const auto opened = open_store(command.store);
  if (!opened) {
    complain("store", opened.error());
    return Exit::error;
  }
  const Status status = act(command, *opened->store);
  if (status) return Exit::valid;
  complain(command.id.empty() ? "store" : command.id, status.error());
  return Exit::error;
}

Exit run(const CompactCommand& command) {
  const auto opened = open_store(command.store);
  if (!opened) {
    complain("store", opened.error());
    return Exit::error;
  }
  const server::StopSignals signals;
  const auto counts = pipeline::compact(
      *opened->store, command.collection, [&signals] { return signals.is_requested(); },
      [](std::uint64_t done, std::uint64_t all) {
        std::fprintf(stderr, "watertight: compact: %llu of %llu features\n",
                     static_cast<unsigned long long>(done), static_cast<unsigned long long>(all));
      });
  if (!counts) {
    complain(command.collection, counts.error());
    return Exit::error;
  }
  std::printf("%-24s %llu\n%-24s %llu\n%-24s %llu\n%-24s %llu\n", "features",
              static_cast<unsigned long long>(counts->features), "packed again",
              static_cast<unsigned long long>(counts->repacked), "bytes of texts before",
              static_cast<unsigned long long>(counts->bytes_before), "bytes of texts after",
              static_cast<unsigned long long>(counts->bytes_after));
  return Exit::valid;
}

}  // namespace watertight::cli
