// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs/strip_file.h"

#include "base/json_text.h"
#include "files/files.h"

namespace watertight::cli {
namespace {

void write_strips(JsonText& json, const SubmittedSolid& solid) {
  json.key("vertices").open('[');
  for (Index vertex = 0; vertex < solid.solid.vertices().size(); ++vertex) {
    json.value(solid.solid.world(vertex));
  }
  json.close(']').key("faces").open('[');
  for (const auto& face : solid.tessellation->face_strips) {
    json.open('{').key("face").value(face.face).key("strips").open('[');
    for (const auto& strip : face.strips) {
      json.open('[');
      for (const Index vertex : strip) json.value(vertex);
      json.close(']');
    }
    json.close(']').close('}');
  }
  json.close(']');
}

}  // namespace

Status save_strips(const Document& document, const std::string& output) {
  JsonText json;
  json.open('{').key("solids").open('[');
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& solid : feature.solids) {
      if (!solid.tessellation) continue;
      json.open('{').key("feature").value(feature.id);
      json.key("object").value(solid.source.object_id);
      write_strips(json, solid);
      json.close('}');
    }
  }
  json.close(']').close('}');
  auto file = files::FileWriter::open(output);
  if (!file) return file.error();
  if (Status written = file->write(json.take() + '\n'); !written) return written;
  return file->commit();
}

}  // namespace watertight::cli
