// SPDX-License-Identifier: GPL-3.0-or-later
//
// Walks tilesets with Cesium's 3d-tiles-tools, which also packs them:
//
//   node walk_tiles.js FOLDER...
//
// Each tileset.json is traversed, the boxes of tiles must hold those of their children, and each
// content is read with its metadata and feature ids. Then the tileset is packed as .3tz and
// unpacked, which must give the same files. Prints a line of JSON for each folder, with the numbers
// of tiles and of features, and of what is wrong.
import {BoundingVolumesContainment, FileResourceResolver, GltfTransform, StructuralMetadataUtils, TilesetConverter, TilesetTraverser} from '3d-tiles-tools';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const EDGE = 1e-3;  // metres by which a box may stand out, since numbers in JSON are rounded

const io = await GltfTransform.getIO();

/** Reads a content; adds its features to the counts, and what is wrong to `wrong`. */
async function readContent(file, counts) {
  const document = await io.readBinary(new Uint8Array(fs.readFileSync(file)));
  const metadata = document.getRoot().getExtension('EXT_structural_metadata');
  const tables = metadata?.listPropertyTables() ?? [];
  if (tables.length !== 1) counts.wrong.push(`${file}: ${tables.length} tables`);
  for (const table of tables) counts.features += table.getCount();
  const text = StructuralMetadataUtils.createStructuralMetadataInfoString(document);
  if (text.length === 0) counts.wrong.push(`${file}: no metadata`);
  for (const mesh of document.getRoot().listMeshes()) {
    for (const primitive of mesh.listPrimitives()) {
      const ids = primitive.getExtension('EXT_mesh_features')?.listFeatureIDs() ?? [];
      const count = tables[0]?.getCount();
      if (ids.length !== 1 || ids[0].getFeatureCount() > count) counts.wrong.push(`${file}: ids`);
    }
  }
}

/** A box with its half axes a little longer. */
function larger(box) {
  const grown = [...box];
  for (let axis = 0; axis < 3; ++axis) grown[3 + 4 * axis] += EDGE;
  return grown;
}

/** The box of a child in the frame of its parent, to which a child is moved and not turned. */
function moved(box, transform) {
  if (!transform) return box;
  const turned = transform.slice(0, 12).some((value, i) => value !== (i % 5 === 0 ? 1 : 0));
  if (turned) throw new Error('a child is turned');
  return [...box.slice(0, 3).map((value, axis) => value + transform[12 + axis]), ...box.slice(3)];
}

/** The corners of a box whose half axes are along the axes. */
function cornersOf(box) {
  const signs = [-1, 1];
  return signs.flatMap(
      (x) => signs.flatMap(
          (y) =>
              signs.map((z) => [box[0] + x * box[3], box[1] + y * box[7], box[2] + z * box[11]])));
}

async function walk(folder) {
  const counts = {tiles: 0, features: 0, wrong: []};
  const tileset = JSON.parse(fs.readFileSync(path.join(folder, 'tileset.json'), 'utf8'));
  const traverser = new TilesetTraverser(folder, new FileResourceResolver(folder));
  await traverser.traverse(tileset, async (traversed) => {
    ++counts.tiles;
    const tile = traversed.asFinalTile();
    const parent = traversed.getParent()?.asFinalTile();
    if (parent) {
      const outer = larger(parent.boundingVolume.box);
      const inner = moved(tile.boundingVolume.box, tile.transform);
      if (!cornersOf(inner).every(
              (corner) => BoundingVolumesContainment.boxContains(outer, corner, 0))) {
        counts.wrong.push(`${traversed.path}: outside of its parent`);
      }
    }
    for (const content of traversed.getFinalContents()) {
      await readContent(path.join(folder, content.uri), counts);
    }
    return true;
  });
  return counts;
}

/** Whether a tileset is the same after it was packed and unpacked. */
async function packs(folder) {
  const place = fs.mkdtempSync(path.join(os.tmpdir(), 'watertight-3tz-'));
  const back = path.join(place, 'back');
  const packed = path.join(place, 'tileset.3tz');
  await TilesetConverter.convert(
      path.join(folder, 'tileset.json'), 'tileset.json', packed, true, undefined);
  await TilesetConverter.convert(packed, 'tileset.json', back, true, undefined);
  const names = fs.readdirSync(folder, {recursive: true, withFileTypes: true})
                    .filter((entry) => entry.isFile())
                    .map((entry) => path.relative(folder, path.join(entry.path, entry.name)));
  const same = names.every(
      (name) =>
          fs.readFileSync(path.join(folder, name)).equals(fs.readFileSync(path.join(back, name))));
  fs.rmSync(place, {recursive: true});
  return same;
}

for (const folder of process.argv.slice(2)) {
  const counts = await walk(folder);
  if (!await packs(folder)) counts.wrong.push('other files after it was packed');
  console.log(JSON.stringify({folder, ...counts}));
}
