// SPDX-License-Identifier: GPL-3.0-or-later
// City models as facets that can be drawn: CityJSON and CityJSONSeq.
//
// A model is {features, crs}; a feature {id, objects}; an object {id, type, geometries}; a geometry
// {type, lod, facets}; a facet {pointer, path, rings, surface}: the JSON Pointer of the facet in
// its document (in a CityJSONSeq, in the line of its feature), its path as val3dity's reports have
// it, rings of positions in the coordinates of the document, and the type of its semantic surface
// or null.

/// How many lists are around a facet in the boundaries of a type of geometry.
const kDepths = {
  MultiSurface: 1,
  CompositeSurface: 1,
  Solid: 2,
  MultiSolid: 3,
  CompositeSolid: 3
};

const escaped = (key) => key.replaceAll('~', '~0').replaceAll('/', '~1');

/// Calls `visit(facet, indices)` for each facet in nested lists.
function eachFacet(boundaries, depth, visit, indices = []) {
  boundaries.forEach((inner, i) => {
    if (depth === 1) {
      visit(inner, [...indices, i]);
    } else {
      eachFacet(inner, depth - 1, visit, [...indices, i]);
    }
  });
}

function surfaceType(semantics, indices) {
  let value = semantics?.values;
  for (const index of indices) value = value?.[index];
  return Number.isInteger(value) ? semantics.surfaces?.[value]?.type ?? null : null;
}

/// The position of a vertex in a document with a transform, or without.
function placer(vertices, transform) {
  const scale = transform?.scale ?? [1, 1, 1];
  const translate = transform?.translate ?? [0, 0, 0];
  return (index) => vertices[index]?.map((step, axis) => step * scale[axis] + translate[axis]);
}

/// The facets of a geometry; `pointer` and `path` name it, `place` gives the position of a vertex.
function facetsOf(geometry, {pointer, path}, place) {
  const depth = kDepths[geometry.type];
  const facets = [];
  if (!depth || !Array.isArray(geometry.boundaries)) return facets;
  eachFacet(geometry.boundaries, depth, (rings, indices) => facets.push({
    pointer: `${pointer}/boundaries/${indices.join('/')}`,
    path: path + facetPath(indices),
    rings: rings.map((ring) => ring.map(place).filter(Boolean)),
    surface: surfaceType(geometry.semantics, indices)
  }));
  return facets;
}

/// The end of the path of a facet: its solid, shell and place in the shell.
function facetPath(indices) {
  const [face, shell = 0, solid = 0] = [...indices].reverse();
  return `|solid=${solid}|shell=${shell}|face=${face}`;
}

/// The facets of an instance of a geometry template.
function instanceOf(geometry, templates, names, place) {
  const template = templates?.templates?.[geometry.template];
  const anchor = place(geometry.boundaries?.[0]);
  const matrix = geometry.transformationMatrix;
  if (!template || !anchor || !Array.isArray(matrix)) return {type: geometry.type, facets: []};
  const vertices = templates['vertices-templates'] ?? [];
  const placeTemplate = (index) => {
    const at = vertices[index];
    if (!at) return undefined;
    return [0, 1, 2].map(
        (row) => matrix[4 * row] * at[0] + matrix[4 * row + 1] * at[1] +
            matrix[4 * row + 2] * at[2] + matrix[4 * row + 3] + anchor[row]);
  };
  const facets = facetsOf(template, names, placeTemplate);
  for (const facet of facets) facet.pointer = names.pointer;  // findings name the instance alone
  return {type: geometry.type, lod: template.lod, facets};
}

function objectsOf(document, head) {
  const place = placer(document.vertices ?? [], document.transform ?? head.transform);
  const templates = document['geometry-templates'] ?? head['geometry-templates'];
  return Object.entries(document.CityObjects ?? {})
      .map(([id, object]) => ({
             id,
             type: object.type,
             top: object.parents?.[0] ?? null,
             geometries: (object.geometry ?? []).map((geometry, number) => {
               const names = {
                 pointer: `/CityObjects/${escaped(id)}/geometry/${number}`,
                 path: `coid=${id}|geom=${number}`
               };
               if (geometry.type === 'GeometryInstance') {
                 return instanceOf(geometry, templates, names, place);
               }
               return {
                 type: geometry.type,
                 lod: String(geometry.lod ?? ''),
                 facets: facetsOf(geometry, names, place)
               };
             })
           }));
}

/// The features of a whole document: each object without parents with all below it.
function featuresOf(document) {
  const objects = objectsOf(document, document);
  const byId = new Map(objects.map((object) => [object.id, object]));
  const features = new Map();
  for (const object of objects) {
    let top = object;
    for (let steps = 0; byId.has(top.top) && steps < 100; ++steps) top = byId.get(top.top);
    if (!features.has(top.id)) features.set(top.id, {id: top.id, objects: []});
    features.get(top.id).objects.push(object);
  }
  return [...features.values()];
}

/// Reads a document. Throws an Error with the reason where it is neither format.
export function readCityModel(text) {
  const lines = text.split('\n').filter((line) => line.trim() !== '');
  if (lines.length === 0) throw new Error('the document is empty');
  let head;
  try {
    head = JSON.parse(lines[0]);
  } catch {
    head = JSON.parse(text);  // one document on several lines
    lines.length = 1;
  }
  if (head?.type === 'CityJSONFeature') {
    return {crs: null, features: [{id: head.id, objects: objectsOf(head, {})}]};
  }
  if (head?.type !== 'CityJSON') throw new Error('the document is no CityJSON');
  const crs = head.metadata?.referenceSystem ?? null;
  const features = featuresOf(head);
  for (const line of lines.slice(1)) {
    const feature = JSON.parse(line);
    if (feature.type === 'CityJSON') {
      head = feature;  // another header
    } else {
      features.push({id: feature.id, objects: objectsOf(feature, head)});
    }
  }
  return {crs, features};
}

/// The levels of detail in a model, the highest first.
export function lodsOf(features) {
  const lods = new Set();
  for (const feature of features) {
    for (const object of feature.objects) {
      for (const geometry of object.geometries) {
        if (geometry.facets.length > 0) lods.add(geometry.lod);
      }
    }
  }
  return [...lods].sort((a, b) => Number(b) - Number(a));
}
