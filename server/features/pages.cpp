// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/pages.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <vector>

#include "report/html/html_page.h"
#include "server/features/feature_text.h"

namespace watertight::server {
namespace {

using report::html_text;

constexpr std::size_t kMostColumns = 6;  // of attributes in a list of items

/// Ways from a page to the address of the service, by the length of the page's own path.
constexpr std::string_view kFromTop = "";
constexpr std::string_view kFromCollection = "../";
constexpr std::string_view kFromItems = "../../";
constexpr std::string_view kFromItem = "../../../";
constexpr std::string_view kFromJob = "../";

/// The head of a page. The script and the style are files of the service itself (web/), and the
/// page may load nothing from elsewhere; compressed tiles are unpacked by WebAssembly.
std::string head(std::string_view title, std::string_view root) {
  std::string out =
      R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; img-src 'self' data:; form-action 'self'; base-uri 'none'">
<link rel="icon" href="data:,">
)";
  out.append("<link rel=\"stylesheet\" href=\"").append(root).append("web/main.css\">\n");
  out.append("<script type=\"module\" src=\"").append(root).append("web/main.js\"></script>\n");
  out.append("<title>").append(html_text(title)).append(" - Watertight</title>\n");
  return out;
}

/// The place of a view of web/src/main.js, which is not seen where there are no scripts.
std::string view(std::string_view name) {
  std::string out = "<section data-view=\"";
  return out.append(name).append("\" hidden></section>\n");
}

std::string anchor(std::string_view href, std::string_view text) {
  std::string out = "<a href=\"";
  return out.append(html_text(href)).append("\">").append(html_text(text)).append("</a>");
}

/// A value as text: strings without quotes, others as JSON.
std::string text_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get<std::string>();
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string cell(const Json& value) {
  std::string out = value.is_number() ? "<td class=\"number\">" : "<td>";
  return out.append(html_text(text_of(value))).append("</td>");
}

std::string heading(std::string_view text, bool is_number = false) {
  std::string out = is_number ? "<th scope=\"col\" class=\"number\">" : "<th scope=\"col\">";
  return out.append(html_text(text)).append("</th>");
}

std::string fact(std::string_view name, const Json& value) {
  std::string out = "<tr><th scope=\"row\">";
  out.append(html_text(name)).append("</th><td>").append(html_text(text_of(value)));
  return out.append("</td></tr>\n");
}

std::string decimal(double value, int digits) {
  std::array<char, 400> text{};  // the largest double
  char* const end = text.data() + text.size();
  return {text.data(),
          std::to_chars(text.data(), end, value, std::chars_format::fixed, digits).ptr};
}

/// The lines of a bbox in CRS84h: from where to where, on each axis.
std::string extent_facts(const Json& bbox) {
  constexpr std::array<std::pair<std::string_view, int>, 3> kAxes{
      {{"Longitude", 6}, {"Latitude", 6}, {"Height", 2}}};
  std::string out;
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis) {
    const auto [name, digits] = kAxes[axis];
    out += fact(name, decimal(bbox[axis].get<double>(), digits) + " to " +
                          decimal(bbox[axis + 3].get<double>(), digits));
  }
  return out;
}

/// The address of the service in a link to one of its collections.
std::string start_of(std::string_view href) {
  return std::string(href.substr(0, href.find("/collections")));
}

std::string link_named(const Json& document, std::string_view relation) {
  for (const Json& item : document["links"]) {
    if (item["rel"] == relation) return item["href"];
  }
  return {};
}

/// A page with its title and a way back along `path`: pairs of address and name.
std::string page(std::string_view title, std::string_view root,
                 const std::vector<std::pair<std::string, std::string>>& path,
                 std::string_view body) {
  std::string out = head(title, root);
  if (!path.empty()) out += "<nav aria-label=\"Path\">";
  for (const auto& [href, name] : path) out.append(anchor(href, name)).append(" / ");
  if (!path.empty()) out += "</nav>\n";
  out.append("<main>\n<h1>").append(html_text(title)).append("</h1>\n").append(body);
  return out.append("</main>\n</html>\n");
}

std::string collection_row(const Json& collection) {
  std::string out = "<tr><td>";
  out += anchor(link_named(collection, "self"), collection["id"].get<std::string>());
  out.append("</td>").append(cell(collection["features"])).append(cell(collection["solids"]));
  out.append(cell(collection["unproven"]["solids"])).append(cell(collection["storageCrs"]));
  return out.append("</tr>\n");
}

/// Names of attributes that features of a page have, in order of their first use.
std::vector<std::string> columns_of(const Json& features) {
  std::vector<std::string> names;
  for (const Json& feature : features) {
    for (const auto& [name, value] : feature["properties"].items()) {
      const bool is_shown = !name.starts_with(pipeline::kOwnProperty) && !value.is_structured();
      if (!is_shown || std::find(names.begin(), names.end(), name) != names.end()) continue;
      if (names.size() < kMostColumns) names.push_back(name);
    }
  }
  return names;
}

std::string proof_cell(const Json& properties) {
  return properties["wt_proven"] == true ? "<td>proven</td>" : "<td class=\"bad\">not proven</td>";
}

std::string item_row(const std::string& address, const Json& feature,
                     const std::vector<std::string>& columns) {
  const Json& properties = feature["properties"];
  const std::string id = feature["id"];
  std::string out = "<tr><td>";
  out.append(anchor(address + "/" + percent_encode(id), id)).append("</td>");
  out.append(cell(properties["wt_type"])).append(proof_cell(properties));
  out.append(cell(properties["wt_solids"]));
  for (const std::string& name : columns) {
    const auto value = properties.find(name);
    out.append(value == properties.end() ? "<td></td>" : cell(*value));
  }
  return out.append("</tr>\n");
}

std::string job_row(const Json& job) {
  const std::string self = link_named(job, "self");
  const std::string name = job.value("name", job["jobID"].get<std::string>());
  std::string out = "<tr><td>";
  out.append(anchor(self, name)).append("</td>").append(cell(job["status"]));
  out.append(cell(job["collection"])).append(cell(job["counts"]["stored"]));
  return out.append(cell(job["created"])).append("</tr>\n");
}

}  // namespace

std::optional<AnswerForm> answer_form(const RoutedRequest& request) {
  if (const std::string* format = request.target.parameter("f")) {
    if (*format == "json") return AnswerForm::json;
    if (*format == "html") return AnswerForm::html;
    return std::nullopt;
  }
  const auto offer = negotiate(request.request.header("accept"), {kJson, kHtml});
  if (!offer) return std::nullopt;
  return *offer == 0 ? AnswerForm::json : AnswerForm::html;
}

Response refuse_forms() {
  return refuse(406, "not-acceptable",
                "this resource is available as application/json (f=json) and text/html (f=html)");
}

Response html_response(std::string page) {
  return Response{200, std::string(kHtmlPage), std::move(page), {{"Vary", "Accept"}}};
}

std::string landing_page(const Json& landing) {
  std::string body = "<p>" + html_text(landing["description"].get<std::string>()) + ".</p>\n";
  body += view("upload");
  body += "<h2>Links</h2>\n<ul>\n";
  for (const Json& item : landing["links"]) {
    const std::string href = item["href"];
    body.append("<li>").append(anchor(href, href)).append(" ");
    body.append(html_text(item["title"].get<std::string>())).append("</li>\n");
  }
  body +=
      "</ul>\n<p>QGIS and GDAL read the collections by the address of this page (OGC API "
      "Features).</p>\n";
  return page(landing["title"].get<std::string>(), kFromTop, {}, body);
}

std::string validate_page(const std::string& start) {
  return page(
      "Validate a file", kFromTop, {{start + "/", "Watertight"}},
      view("upload") +
          "<noscript><p>This page needs scripts. Without them send the file to this address "
          "by another program: <code>curl --data-binary @town.city.json -H 'Accept: "
          "text/html' ADDRESS</code></p></noscript>\n");
}

std::string conformance_page(const Json& conformance) {
  std::string body = "<ul>\n";
  for (const Json& name : conformance["conformsTo"]) {
    body.append("<li>").append(html_text(name.get<std::string>())).append("</li>\n");
  }
  return page("Conformance", kFromTop, {}, body + "</ul>\n");
}

std::string collections_page(const Json& collections) {
  const std::string start = start_of(link_named(collections, "self"));
  if (collections["collections"].empty()) {
    return page("Collections", kFromTop, {{start + "/", "Watertight"}},
                "<p>There is no collection yet.</p>\n");
  }
  std::string body = view("filter") + "<table>\n<tr>" + heading("Collection") +
                     heading("Features", true) + heading("Solids", true) +
                     heading("Not proven", true) + heading("CRS") + "</tr>\n";
  for (const Json& collection : collections["collections"]) body += collection_row(collection);
  body += "</table>\n";
  const std::string next = link_named(collections, "next");
  if (!next.empty()) body.append("<p>").append(anchor(next, "Next page")).append("</p>\n");
  return page("Collections", kFromTop, {{start + "/", "Watertight"}}, body);
}

std::string collection_page(const Json& collection) {
  const std::string self = link_named(collection, "self");
  const std::string start = start_of(self);
  std::string body = view("city") + "<table>\n";
  body += fact("Features", collection["features"]);
  body += fact("Solids", collection["solids"]);
  body += fact("Solids that are not proven", collection["unproven"]["solids"]);
  body += fact("Bytes of solids", collection["blobBytes"]);
  body += fact("Documents with invalid features", collection["invalid"]);
  body += fact("CRS of storage", collection["storageCrs"]);
  if (collection.contains("extent")) {
    body += extent_facts(collection["extent"]["spatial"]["bbox"][0]);
  }
  body += "</table>\n<ul>\n";
  body += "<li>" + anchor(self + "/items", "Features") + "</li>\n";
  body += "<li>" + anchor(self + "/items?proven=false", "Features that are not proven") + "</li>\n";
  for (const Json& item : collection["links"]) {
    if (item["rel"] == "self" || item["rel"] == "items") continue;
    body.append("<li>").append(
        anchor(item["href"].get<std::string>(), item["title"].get<std::string>()));
    body += "</li>\n";
  }
  return page(collection["id"].get<std::string>(), kFromCollection,
              {{start + "/", "Watertight"}, {start + "/collections", "Collections"}},
              body + "</ul>\n");
}

std::string items_page(const std::string& collection, const Json& items) {
  const std::string up = link_named(items, "collection");
  const std::string start = start_of(up);
  const std::vector<std::string> columns = columns_of(items["features"]);
  std::string body =
      view("filter") + "<p>Features on this page: " + text_of(items["numberReturned"]);
  if (items.contains("numberMatched")) body += " of " + text_of(items["numberMatched"]);
  body += ".</p>\n<table>\n<tr>" + heading("Feature") + heading("Type") + heading("Proof") +
          heading("Solids", true);
  for (const std::string& name : columns) body += heading(name);
  body += "</tr>\n";
  for (const Json& feature : items["features"]) body += item_row(up + "/items", feature, columns);
  body += "</table>\n";
  const std::string next = link_named(items, "next");
  if (!next.empty()) body.append("<p>").append(anchor(next, "Next page")).append("</p>\n");
  return page(
      "Features of " + collection, kFromItems,
      {{start + "/", "Watertight"}, {start + "/collections", "Collections"}, {up, collection}},
      body);
}

std::string item_page(const std::string& collection, const Json& feature) {
  std::string body = view("item") + "<table>\n";
  for (const auto& [name, value] : feature["properties"].items()) body += fact(name, value);
  if (feature.contains("bbox")) body += extent_facts(feature["bbox"]);
  body += "</table>\n<h2>As a file</h2>\n<ul>\n";
  constexpr std::pair<std::string_view, std::string_view> kForms[] = {
      {"?f=cityjson", "CityJSON"},
      {"?f=cityjsonseq", "CityJSONSeq"},
      {"?f=geojson", "GeoJSON"},
      {"?f=jsonfg", "JSON-FG"},
      {"?f=gml", "CityGML"},
      {"?f=obj", "OBJ"},
      {"?f=wkt", "WKT"},
      {"?f=glb", "binary glTF"},
      {"?f=wt", "Watertight file"},
      {"?f=proof", "Proof, measures and findings (JSON)"},
      {"?f=structure", "Tetrahedra, Steiner points and bytes (JSON)"}};
  for (const auto& [href, name] : kForms) {
    body.append("<li>").append(anchor(href, name)).append("</li>\n");
  }
  return page(feature["id"].get<std::string>(), kFromItem,
              {{"../..", "Collections"}, {"..", collection}, {"../items", "Features"}},
              body + "</ul>\n");
}

std::string jobs_page(const Json& jobs) {
  const std::vector<std::pair<std::string, std::string>> path = {{"./", "Watertight"}};
  if (jobs["jobs"].empty()) {
    return page("Jobs", kFromTop, path,
                "<p>There is no job. A file that is longer than a page can show, or an archive, "
                "becomes one when it is dropped on the first page.</p>\n");
  }
  std::string body = "<table>\n<tr>" + heading("Job") + heading("Status") + heading("Collection") +
                     heading("Features stored", true) + heading("Made") + "</tr>\n";
  for (const Json& job : jobs["jobs"]) body += job_row(job);
  body += "</table>\n";
  const std::string next = link_named(jobs, "next");
  if (!next.empty()) body.append("<p>").append(anchor(next, "Older jobs")).append("</p>\n");
  return page("Jobs", kFromTop, path, body);
}

std::string job_page(const Json& job) {
  const bool is_over = job.contains("finished");
  std::string body = is_over ? "" : view("job");
  body += "<table>\n";
  constexpr std::pair<const char*, std::string_view> kFacts[] = {
      {"status", "Status"},    {"message", "Message"}, {"collection", "Collection"},
      {"bytes", "Bytes sent"}, {"created", "Sent"},    {"started", "Begun"},
      {"finished", "Over"}};
  for (const auto& [name, text] : kFacts) {
    if (job.contains(name)) body += fact(text, job[name]);
  }
  constexpr std::pair<const char*, std::string_view> kCounts[] = {
      {"features", "Features"},
      {"valid", "Features that are valid"},
      {"invalid", "Features that are not valid"},
      {"undecided", "Features that are undecided"},
      {"stored", "Features stored"},
      {"unprovenFeatures", "Features stored without proof"},
      {"unprovenSolids", "Solids stored without proof"}};
  for (const auto& [name, text] : kCounts) body += fact(text, job["counts"][name]);
  body += "</table>\n<ul>\n";
  for (const Json& item : job["links"]) {
    if (item["rel"] == "self" || item["rel"] == "monitor") continue;
    body.append("<li>").append(
        anchor(item["href"].get<std::string>(), item["title"].get<std::string>()));
    body += "</li>\n";
  }
  return page("Job " + job.value("name", job["jobID"].get<std::string>()), kFromJob,
              {{"../", "Watertight"}, {"../jobs", "Jobs"}}, body + "</ul>\n");
}

}  // namespace watertight::server
