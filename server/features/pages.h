// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers as HTML pages for people. They load nothing from elsewhere. All facts are in them without
// scripts; with scripts (web/) they have pictures, and take files. Internal to server/.
#pragma once

#include <optional>
#include <string>

#include "server/handlers.h"
#include "server/json_answers.h"

namespace watertight::server {

enum class AnswerForm : std::uint8_t { json, html };

/// The form that a client wants, by the parameter `f` or the Accept header; JSON if it takes both
/// alike. Nothing if it takes neither.
std::optional<AnswerForm> answer_form(const RoutedRequest& request);

/// The refusal of a client that takes neither JSON nor HTML.
Response refuse_forms();

Response html_response(std::string page);

/// The page that judges a file; `start` is the address of the service.
std::string validate_page(const std::string& start);

/// The pages of answers in JSON: of `/`, `/conformance`, `/collections`, one collection, a list of
/// items and one item, which is a GeoJSON Feature.
std::string landing_page(const Json& landing);
std::string conformance_page(const Json& conformance);
std::string collections_page(const Json& collections);
std::string collection_page(const Json& collection);
std::string items_page(const std::string& collection, const Json& items);
std::string item_page(const std::string& collection, const Json& feature);

/// The pages of the list of jobs and of one job.
std::string jobs_page(const Json& jobs);
std::string job_page(const Json& job);

}  // namespace watertight::server
