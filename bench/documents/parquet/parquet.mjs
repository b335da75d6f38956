// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of CityJSON documents as Parquet, written by DuckDB with Zstandard.
//
//     npm install && node parquet.mjs FILE...
//
// A document is a table with a row for each city object: feature, id, type, parents, children,
// attributes (a column each, of the type that DuckDB finds), geometry (type and lod; boundaries, semantics,
// materials and textures as JSON) and the vertices that the geometry uses, as three lists of integers, numbered
// anew for each object. So an object can be read alone. The header and the exact text of the
// document are not in it. Prints a row for each document.
import {DuckDBInstance} from "@duckdb/node-api";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";

/** The documents of a file with the objects in each: [vertices, feature id, objects]. */
function* features(file) {
  const text = fs.readFileSync(file, "utf8");
  const values = file.endsWith("l") ? text.trim().split("\n").map(JSON.parse) : [JSON.parse(text)];
  for (const value of values) {
    for (const [id, object] of Object.entries(value.CityObjects ?? {})) {
      yield [value.vertices, value.id ?? id, id, object];
    }
  }
}

/** The boundaries with vertices numbered anew, in the order of their first use. */
function renumbered(boundaries, numbers) {
  if (!Array.isArray(boundaries)) {
    if (!numbers.has(boundaries)) numbers.set(boundaries, numbers.size);
    return numbers.get(boundaries);
  }
  return boundaries.map((part) => renumbered(part, numbers));
}

function row([vertices, feature, id, object]) {
  const numbers = new Map();
  const geometry = (object.geometry ?? []).map((item) => ({
    ...item, boundaries: item.boundaries && JSON.stringify(renumbered(item.boundaries, numbers)),
    semantics: item.semantics && JSON.stringify(item.semantics),
    texture: item.texture && JSON.stringify(item.texture),
    material: item.material && JSON.stringify(item.material)}));
  const used = [...numbers.keys()].map((number) => vertices[number] ?? [0, 0, 0]);
  return {feature, id, type: object.type, parents: object.parents, children: object.children,
    extent: object.geographicalExtent, attributes: object.attributes, geometry,
    x: used.map((vertex) => vertex[0]), y: used.map((vertex) => vertex[1]), z: used.map((vertex) => vertex[2])};
}

const folder = fs.mkdtempSync(path.join(os.tmpdir(), "parquet-"));
const connection = await (await DuckDBInstance.create()).connect();
console.log("| document | bytes | Parquet |\n|---|---|---|");
for (const file of process.argv.slice(2)) {
  const rows = path.join(folder, "rows.jsonl");
  const out = path.join(folder, "out.parquet");
  fs.writeFileSync(rows, [...features(file)].map((item) => JSON.stringify(row(item))).join("\n"));
  await connection.run(`COPY (SELECT * FROM read_json('${rows}', format = 'newline_delimited', sample_size = -1,
    maximum_object_size = 1000000000, map_inference_threshold = -1, field_appearance_threshold = 0))
    TO '${out}' (FORMAT parquet, COMPRESSION zstd, COMPRESSION_LEVEL 19, PARQUET_VERSION v2)`);
  console.log(`| ${path.basename(file)} | ${fs.statSync(file).size} | ${fs.statSync(out).size} |`);
}
fs.rmSync(folder, {recursive: true});
