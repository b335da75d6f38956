// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads a submitted body: finds its format and reads the document. Internal to server/.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "formats/feature_reader.h"
#include "server/budget.h"
#include "server/handlers.h"

namespace watertight::server {

/// The type that a JSON body states at its top level: "CityJSON", "CityJSONFeature" or another
/// word; "" when there is none. Reads no further than needed.
std::string top_level_type(std::string_view json);

/// The formats that clients may send: those whose features have ids, so that they can be stored, or
/// all.
enum class AcceptedFormats : std::uint8_t { with_ids, all };

/// The document in a body, or the problem with it: 400 malformed, 413, 415, 422, 503. The format
/// follows from f=, else from Content-Type. A CityJSONSeq is read while it is used, so the request
/// must outlive the reader; other documents are read whole. Both hold a share of the memory for
/// documents until they are stored. `header` is the document header that a bare CityJSONFeature
/// needs to be stored (that of the collection), "" when there is none.
struct Submission {
  std::unique_ptr<BudgetShare> memory;
  std::optional<formats::FeatureReader> reader;
  std::optional<Problem> problem;
};
Submission read_submission(const RoutedRequest& request, AcceptedFormats accepted,
                           const std::string& header,
                           formats::Surfaces surfaces = formats::Surfaces::ignore);

/// The memory for a body and its format; or the problem with it.
struct BodyFormat {
  std::unique_ptr<BudgetShare> memory;
  Format format = Format::city_json;
  std::optional<Problem> problem;
};
/// Any format is accepted.
BodyFormat body_format(const RoutedRequest& request);

/// A document that is read whole, to be written in another form; or the problem with it.
struct Conversion {
  std::unique_ptr<BudgetShare> memory;
  std::optional<Document> document;
  std::optional<Problem> problem;
};
/// Reads the document in a body, of any format, to write it as `to`; nothing: with its text, to be
/// written as it was.
Conversion read_conversion(const RoutedRequest& request, std::optional<Format> to,
                           formats::Surfaces surfaces);

/// The media types of bodies whose features can be stored, with commas between them.
std::string storable_types();

/// The media type of documents of a format; "application/octet-stream" where there is none.
std::string_view media_type_of(Format format);

/// The memory for a body that is a Watertight file, which has no reader; or the problem: 413, 503.
Submission container_submission(const RoutedRequest& request);

/// The header of the collection if the body is a bare feature, which needs one; else "". Errors:
/// conflict when its features have several headers, as the feature would be read wrongly.
Result<std::string> header_for(const RoutedRequest& request);

/// The problem with a body that could not be read.
Problem problem_of_body(const Error& error);

/// True if the body is a Watertight file.
bool is_container_body(const RoutedRequest& request);

/// True if the body is a single CityJSONFeature, which needs a header from elsewhere.
bool is_bare_feature(const RoutedRequest& request);

}  // namespace watertight::server
