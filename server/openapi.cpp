// SPDX-License-Identifier: GPL-3.0-or-later
//
// The OpenAPI document. A test compares it with the route table.
#include "server/handlers.h"

namespace watertight::server {
namespace {

constexpr char kOpenApi[] = R"json({
"openapi": "3.0.3",
"info": {"title": "Watertight", "version": "0.1.0", "description": "Validates, stores and compresses 3D solids. Every error answer is application/problem+json (RFC 9457).", "license": {"name": "GPL-3.0-or-later", "url": "https://www.gnu.org/licenses/gpl-3.0.html"}},
"servers": [{"url": "/"}],
"tags": [{"name": "service"}, {"name": "collections"}, {"name": "validation"}],
"paths": {
"/": {
"get": {
"operationId": "getLanding",
"summary": "Landing page",
"tags": ["service"],
"parameters": [{"name": "f", "in": "query", "description": "Answer format, instead of Accept", "schema": {"type": "string", "enum": ["json", "html"]}}],
"responses": {"200": {"description": "Links to everything else", "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Links"}}, "text/html": {"schema": {"type": "string"}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/api": {
"get": {
"operationId": "getApi",
"summary": "This document",
"tags": ["service"],
"parameters": [{"name": "f", "in": "query", "description": "Answer format, instead of Accept", "schema": {"type": "string", "enum": ["json"]}}],
"responses": {"200": {"description": "OpenAPI 3", "content": {"application/vnd.oai.openapi+json;version=3.0": {"schema": {"type": "object"}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/healthz": {
"get": {
"operationId": "getHealth",
"summary": "Is the process alive",
"tags": ["service"],
"responses": {"200": {"description": "It is", "content": {"application/json": {"schema": {"type": "object", "properties": {"status": {"type": "string"}}}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/readyz": {
"get": {
"operationId": "getReadiness",
"summary": "Does the database answer",
"tags": ["service"],
"responses": {"200": {"description": "It does", "content": {"application/json": {"schema": {"type": "object", "properties": {"status": {"type": "string"}}}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/collections": {
"get": {
"operationId": "getCollections",
"summary": "All collections",
"tags": ["collections"],
"parameters": [{"name": "f", "in": "query", "description": "Answer format, instead of Accept", "schema": {"type": "string", "enum": ["json"]}}],
"responses": {"200": {"description": "Collections", "content": {"application/json": {"schema": {"type": "object", "required": ["links", "collections"], "properties": {"links": {"type": "array", "items": {"$ref": "#/components/schemas/Link"}}, "collections": {"type": "array", "items": {"$ref": "#/components/schemas/Collection"}}}}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/collections/{collectionId}": {
"get": {
"operationId": "getCollection",
"summary": "One collection",
"tags": ["collections"],
"parameters": [{"name": "collectionId", "in": "path", "description": "Collection", "schema": {"type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$"}, "required": true}, {"name": "f", "in": "query", "description": "Answer format, instead of Accept", "schema": {"type": "string", "enum": ["json"]}}],
"responses": {"200": {"description": "The collection", "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Collection"}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "404": {"description": "No such collection or feature", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/collections/{collectionId}/items": {
"get": {
"operationId": "getItems",
"summary": "Features of a collection, by id",
"tags": ["collections"],
"parameters": [{"name": "collectionId", "in": "path", "description": "Collection", "schema": {"type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$"}, "required": true}, {"name": "f", "in": "query", "description": "Answer format, instead of Accept", "schema": {"type": "string", "enum": ["json"]}}, {"name": "limit", "in": "query", "description": "Features a page; more than 1000 counts as 1000", "schema": {"type": "integer", "minimum": 1, "default": 10}}, {"name": "after", "in": "query", "description": "Id after which the page starts; take it from the next link", "schema": {"type": "string"}}, {"name": "bbox", "in": "query", "description": "4 or 6 numbers: minima, then maxima, in the CRS of bbox-crs", "schema": {"type": "array", "minItems": 4, "maxItems": 6, "items": {"type": "number"}}}, {"name": "bbox-crs", "in": "query", "description": "The collection's storageCrs; required with bbox", "schema": {"type": "string", "format": "uri"}}],
"responses": {"200": {"description": "A page", "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Items"}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "404": {"description": "No such collection or feature", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
},
"post": {
"operationId": "postItems",
"summary": "Validate and store a document",
"tags": ["collections"],
"description": "CityJSON, a CityJSONSeq, or one CityJSONFeature (which takes the transform of the collection's header). The collection is made when it does not exist.",
"parameters": [{"name": "collectionId", "in": "path", "description": "Collection", "schema": {"type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$"}, "required": true}, {"name": "f", "in": "query", "description": "Body format, instead of Content-Type", "schema": {"type": "string", "enum": ["cityjson", "json", "cityjsonseq"]}}, {"name": "invalid", "in": "query", "description": "refuse: store all features or none; skip: store the valid ones and report the rest", "schema": {"type": "string", "enum": ["refuse", "skip"], "default": "refuse"}}],
"requestBody": {"required": true, "content": {"application/city+json": {"schema": {"type": "object"}}, "application/city+json-seq": {"schema": {"type": "string", "format": "binary"}}, "application/x-ndjson": {"schema": {"type": "string", "format": "binary"}}, "application/json": {"schema": {"type": "object"}}}},
"responses": {"200": {"description": "invalid=skip and nothing was valid", "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Outcome"}}}}, "201": {"description": "Stored; a feature of an id that existed was replaced", "headers": {"Location": {"description": "the feature, when it is one", "schema": {"type": "string"}}}, "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Outcome"}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "409": {"description": "Another CRS than the collection's", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "411": {"description": "Neither Content-Length nor chunked", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "413": {"description": "Body or document larger than the limits", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "415": {"description": "Not a format taken here, or a Content-Encoding", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "422": {"description": "Solids that are invalid (type invalid-solids) or undecided (undecided-solids, with Retry-After); member report has the outcome; nothing stored", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/collections/{collectionId}/items/{itemId}": {
"get": {
"operationId": "getItem",
"summary": "One feature, decoded",
"tags": ["collections"],
"parameters": [{"name": "collectionId", "in": "path", "description": "Collection", "schema": {"type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$"}, "required": true}, {"name": "itemId", "in": "path", "description": "Feature: id of its top-level city object, percent-encoded", "schema": {"type": "string", "maxLength": 1024}, "required": true}, {"name": "f", "in": "query", "description": "Answer format, instead of Accept", "schema": {"type": "string", "enum": ["cityjson", "json", "cityjsonseq", "obj", "wt", "blob"]}}, {"name": "solid", "in": "query", "description": "With f=blob: which solid, from 0; needed when there are several", "schema": {"type": "integer", "minimum": 0}}],
"responses": {"200": {"description": "The feature", "headers": {"ETag": {"description": "names this version in this format", "schema": {"type": "string"}}}, "content": {"application/city+json": {"schema": {"type": "object"}}, "application/json": {"schema": {"type": "object"}}, "application/city+json-seq": {"schema": {"type": "string", "format": "binary"}}, "model/obj": {"schema": {"type": "string", "format": "binary"}}, "application/vnd.watertight": {"schema": {"type": "string", "format": "binary"}}, "application/vnd.watertight.blob": {"schema": {"type": "string", "format": "binary"}}}}, "304": {"description": "If-None-Match names the current version"}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "404": {"description": "No such collection or feature", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
},
"delete": {
"operationId": "deleteItem",
"summary": "Delete a feature",
"tags": ["collections"],
"parameters": [{"name": "collectionId", "in": "path", "description": "Collection", "schema": {"type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$"}, "required": true}, {"name": "itemId", "in": "path", "description": "Feature: id of its top-level city object, percent-encoded", "schema": {"type": "string", "maxLength": 1024}, "required": true}],
"responses": {"204": {"description": "Deleted"}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "404": {"description": "No such collection or feature", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/collections/{collectionId}/export": {
"get": {
"operationId": "getExport",
"summary": "A whole collection as one file",
"tags": ["collections"],
"description": "In order of place: neighbours share pages. Larger files come in chunks while they are made; one that cannot be finished ends without its last chunk. A feature that is put or removed meanwhile may be missing or there, and one that is put at another place may be there twice; each is whole.",
"parameters": [{"name": "collectionId", "in": "path", "description": "Collection", "schema": {"type": "string", "pattern": "^[A-Za-z0-9_.-]{1,64}$"}, "required": true}, {"name": "f", "in": "query", "description": "Format of the file, instead of Accept", "schema": {"type": "string", "enum": ["wt", "cityjsonseq"], "default": "wt"}}],
"responses": {"200": {"description": "The file", "headers": {"Content-Disposition": {"description": "a name for the file", "schema": {"type": "string"}}, "Content-Crs": {"description": "the collection's storage CRS", "schema": {"type": "string"}}}, "content": {"application/vnd.watertight": {"schema": {"type": "string", "format": "binary"}}, "application/city+json-seq": {"schema": {"type": "string", "format": "binary"}}}}, "400": {"description": "Not understood: parameter or path", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "404": {"description": "No such collection, or one without features", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given; a CityJSONSeq takes city models with one header only", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "500": {"description": "What is stored is damaged", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy (downloads have a limit of their own), out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
},
"/validate": {
"post": {
"operationId": "postValidate",
"summary": "Validate a document; nothing is stored",
"tags": ["validation"],
"parameters": [{"name": "f", "in": "query", "description": "Body format, instead of Content-Type", "schema": {"type": "string", "enum": ["cityjson", "json", "cityjsonseq", "obj", "off", "wkt", "wkb", "ewkb", "gml", "jsonfg", "stl", "ply", "poly"]}}, {"name": "planarity", "in": "query", "description": "Largest distance of a vertex from its facet's plane, metres", "schema": {"type": "number", "default": 0.01}}, {"name": "planarity-angle", "in": "query", "description": "Largest angle between two triangles of a facet, degrees", "schema": {"type": "number", "default": 20}}, {"name": "proof", "in": "query", "description": "What proves validity", "schema": {"type": "string", "enum": ["tetrahedralization", "boundary"], "default": "tetrahedralization"}}, {"name": "strict", "in": "query", "description": "Only the canonical triangles of facets count", "schema": {"type": "boolean", "default": false}}],
"requestBody": {"required": true, "content": {"application/city+json": {"schema": {"type": "object"}}, "application/city+json-seq": {"schema": {"type": "string", "format": "binary"}}, "application/x-ndjson": {"schema": {"type": "string", "format": "binary"}}, "application/json": {"schema": {"type": "object"}}, "model/obj": {"schema": {"type": "string", "format": "binary"}}, "model/vnd.off": {"schema": {"type": "string", "format": "binary"}}, "text/wkt": {"schema": {"type": "string"}}, "application/wkb": {"schema": {"type": "string", "format": "binary"}}, "application/ewkb": {"schema": {"type": "string", "format": "binary"}}, "application/gml+xml": {"schema": {"type": "string", "format": "binary"}}, "application/xml": {"schema": {"type": "string", "format": "binary"}}, "text/xml": {"schema": {"type": "string", "format": "binary"}}, "application/vnd.ogc.fg+json": {"schema": {"type": "object"}}, "application/geo+json": {"schema": {"type": "object"}}, "model/stl": {"schema": {"type": "string", "format": "binary"}}, "model/x-ply": {"schema": {"type": "string", "format": "binary"}}, "application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}},
"description": "Accept chooses the answer: the report (docs/schema/report-2.schema.json, a superset of val3dity's), a layer of findings, or a page for people. 200 whatever the verdict.",
"responses": {"200": {"description": "The report", "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Report"}}, "application/geo+json": {"schema": {"type": "object"}}, "text/html": {"schema": {"type": "string"}}}}, "400": {"description": "Not understood: parameter, path or body; byteOffset and pointer say where", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "406": {"description": "None of the accepted formats can be given", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "411": {"description": "Neither Content-Length nor chunked", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "413": {"description": "Body or document larger than the limits", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "415": {"description": "Not a format taken here, or a Content-Encoding", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "422": {"description": "A format that is known, with content that is not", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}}, "503": {"description": "Too busy, out of memory, or the database is away; try again", "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}}, "headers": {"Retry-After": {"description": "seconds to wait", "schema": {"type": "integer"}}}}}
}
}
},
"components": {
"schemas": {
"Link": {"type": "object", "required": ["href", "rel"], "properties": {"href": {"type": "string"}, "rel": {"type": "string"}, "type": {"type": "string"}, "title": {"type": "string"}}},
"Links": {"type": "object", "required": ["links"], "properties": {"title": {"type": "string"}, "description": {"type": "string"}, "links": {"type": "array", "items": {"$ref": "#/components/schemas/Link"}}}},
"Collection": {"type": "object", "required": ["id", "links", "storageCrs"], "properties": {"id": {"type": "string"}, "itemType": {"type": "string"}, "crs": {"type": "array", "items": {"type": "string"}}, "storageCrs": {"type": "string"}, "extent": {"type": "object"}, "features": {"type": "integer"}, "solids": {"type": "integer"}, "blobBytes": {"type": "integer"}, "links": {"type": "array", "items": {"$ref": "#/components/schemas/Link"}}}},
"Items": {"type": "object", "required": ["type", "features", "links", "numberMatched", "numberReturned"], "properties": {"type": {"type": "string", "enum": ["FeatureCollection"]}, "links": {"type": "array", "items": {"$ref": "#/components/schemas/Link"}}, "numberMatched": {"type": "integer"}, "numberReturned": {"type": "integer"}, "features": {"type": "array", "items": {"type": "object", "required": ["type", "id", "geometry", "properties"], "properties": {"type": {"type": "string", "enum": ["Feature"]}, "id": {"type": "string"}, "bbox": {"type": "array", "items": {"type": "number"}, "minItems": 6, "maxItems": 6}, "geometry": {"type": "object", "nullable": true}, "properties": {"type": "object"}, "links": {"type": "array", "items": {"$ref": "#/components/schemas/Link"}}}}}}},
"Verdict": {"type": "string", "enum": ["valid", "invalid", "undecided"]},
"Outcome": {"type": "object", "required": ["verdict", "stored", "features"], "properties": {"verdict": {"$ref": "#/components/schemas/Verdict"}, "stored": {"type": "integer", "description": "features"}, "features": {"type": "array", "items": {"type": "object", "required": ["id", "verdict", "stored", "solids"], "properties": {"id": {"type": "string"}, "verdict": {"$ref": "#/components/schemas/Verdict"}, "stored": {"type": "boolean"}, "solids": {"type": "array", "items": {"type": "object", "required": ["object", "geometryType", "geometry", "ordinal", "report"], "properties": {"object": {"type": "string"}, "geometryType": {"type": "string"}, "lod": {"type": "string"}, "geometry": {"type": "integer"}, "ordinal": {"type": "integer"}, "pointer": {"type": "string"}, "blobBytes": {"type": "integer"}, "report": {"type": "object", "description": "see docs/report.md"}}}}}}}}},
"Report": {"type": "object", "required": ["type", "schema", "features", "validity", "verdict"], "properties": {"type": {"type": "string", "enum": ["val3dity_report"]}, "schema": {"type": "integer", "enum": [2]}, "validity": {"type": "boolean"}, "verdict": {"$ref": "#/components/schemas/Verdict"}, "all_errors": {"type": "array", "items": {"type": "integer"}}, "features": {"type": "array", "items": {"type": "object"}}}},
"Problem": {"type": "object", "required": ["type", "title", "status"], "properties": {"type": {"type": "string"}, "title": {"type": "string"}, "status": {"type": "integer"}, "detail": {"type": "string"}, "byteOffset": {"type": "integer", "description": "into the request body"}, "pointer": {"type": "string", "description": "JSON Pointer into the request body"}, "report": {"$ref": "#/components/schemas/Outcome"}}}
}
}
}
)json";

}  // namespace

std::string openapi_text() { return kOpenApi; }

}  // namespace watertight::server
