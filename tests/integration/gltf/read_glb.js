// SPDX-License-Identifier: GPL-3.0-or-later
//
// Validates .glb files with Khronos' glTF validator and reads them with the decoder of
// meshoptimizer:
//
//   node read_glb.js FILE...
//
// Prints a line of JSON for each file: the numbers of errors and warnings, and for each feature its
// id, the area of its triangles and the middle of that area.
import validator from 'gltf-validator';
import {MeshoptDecoder} from 'meshoptimizer/decoder';
import fs from 'node:fs';

const COMPONENTS = {
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array
};
const SIZES = {
  SCALAR: 1,
  VEC3: 3
};

/** The parts of a .glb. */
function parse(file) {
  const bytes = fs.readFileSync(file);
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString('utf8'));
  return {json, binary: bytes.subarray(28 + length)};
}

/** The bytes of a view, expanded. */
function viewBytes(glb, number) {
  const view = glb.json.bufferViews[number];
  const coded = view.extensions?.EXT_meshopt_compression;
  if (!coded) return glb.binary.subarray(view.byteOffset, view.byteOffset + view.byteLength);
  const out = new Uint8Array(coded.count * coded.byteStride);
  const source = glb.binary.subarray(coded.byteOffset, coded.byteOffset + coded.byteLength);
  MeshoptDecoder.decodeGltfBuffer(out, coded.count, coded.byteStride, source, coded.mode, 'NONE');
  return out;
}

/** The values of an accessor, one array for each element. */
function values(glb, number) {
  const accessor = glb.json.accessors[number];
  const bytes = viewBytes(glb, accessor.bufferView);
  const Component = COMPONENTS[accessor.componentType];
  const size = SIZES[accessor.type];
  const stride =
      glb.json.bufferViews[accessor.bufferView].byteStride ?? size * Component.BYTES_PER_ELEMENT;
  return Array.from({length: accessor.count}, (_, i) => {
    const start = i * stride;
    const own = bytes.slice(start, start + size * Component.BYTES_PER_ELEMENT);
    return Array.from(new Component(own.buffer, own.byteOffset, size));
  });
}

/** The texts of a column of the property table. */
function texts(glb, column) {
  const bytes = viewBytes(glb, column.values);
  const offsets = viewBytes(glb, column.stringOffsets);
  const count = glb.json.extensions.EXT_structural_metadata.propertyTables[0].count;
  const at = (i) => Buffer.from(offsets).readUInt32LE(i * 4);
  return Array.from(
      {length: count}, (_, i) => Buffer.from(bytes.slice(at(i), at(i + 1))).toString('utf8'));
}

const minus = (a, b) => a.map((value, axis) => value - b[axis]);
const cross =
    (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function features(glb) {
  const table = glb.json.extensions.EXT_structural_metadata.propertyTables[0];
  const found = texts(glb, table.properties.id).map((id) => ({id, area: 0, middle: [0, 0, 0]}));
  for (const primitive of glb.json.meshes[0].primitives) {
    if (primitive.mode !== 4) continue;
    const positions = values(glb, primitive.attributes.POSITION);
    const ids = values(glb, primitive.attributes._FEATURE_ID_0);
    const corners = values(glb, primitive.indices).flat();
    for (let i = 0; i < corners.length; i += 3) {
      const [a, b, c] = corners.slice(i, i + 3).map((corner) => positions[corner]);
      const area = Math.hypot(...cross(minus(b, a), minus(c, a))) / 2;
      const feature = found[ids[corners[i]][0]];
      feature.area += area;
      feature.middle =
          feature.middle.map((sum, axis) => sum + (area * (a[axis] + b[axis] + c[axis])) / 3);
    }
  }
  for (const feature of found) feature.middle = feature.middle.map((sum) => sum / feature.area);
  return found;
}

await MeshoptDecoder.ready;
for (const file of process.argv.slice(2)) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
  const {numErrors, numWarnings, messages} = report.issues;
  const bad = messages.filter((message) => message.severity < 2);
  console.log(JSON.stringify(
      {file, errors: numErrors, warnings: numWarnings, bad, features: features(parse(file))}));
}
