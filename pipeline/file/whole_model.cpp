// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/file/whole_model.h"

namespace watertight::pipeline {

bool is_whole_model(const Feature& feature) {
  return feature.id.empty() && feature.type == "CityJSON";
}

Result<Document> split_model(const formats::CityHeader& header, const Feature& model,
                             const Limits& limits) {
  const auto text = formats::write_city_json_feature(header, model);
  if (!text) return text.error();
  formats::ReadOptions options;
  options.limits = limits;
  return formats::read_city_json(*text, options);
}

}  // namespace watertight::pipeline
