// SPDX-License-Identifier: GPL-3.0-or-later
// Findings of reports as one list.
//
// An entry is {feature, code, name, severity, text, hint, pointer, other, witness}; pointers are
// paths where the document has no JSON Pointers.

/// Units of sizes; numbers of things are in the text of a finding already.
const kUnits = new Set(['m', 'm2', 'm3', 'degrees']);

/// The path of the facet in one of the two parts of an id; null without a facet.
const facetPath = (id) => id?.match(/^.*\|face=\d+/)?.[0] ?? null;

function entry(feature, finding) {
  const measured = kUnits.has(finding.unit) && Number.isFinite(finding.measured) ?
      ` (${Number(finding.measured.toPrecision(4))} ${finding.unit})` :
      '';
  return {
    feature,
    code: finding.code,
    name: finding.name,
    severity: finding.severity,
    text: (finding.info || finding.summary) + measured,
    hint: finding.hint ?? '',
    pointer: finding.pointer ?? facetPath(finding.id?.split('&&')[0]),
    other: finding.other_pointer ?? facetPath(finding.id?.split('&&')[1]),
    witness: finding.witness ?? null
  };
}

/// The findings of the report of a document, errors before warnings.
export function findingsOfReport(report) {
  const list = [];
  for (const feature of report.features ?? []) {
    for (const finding of [...feature.errors, ...feature.warnings]) {
      list.push(entry(feature.id, finding));
    }
  }
  return errorsFirst(list);
}

/// The findings of a stored feature (`f=proof`), errors before warnings.
export function findingsOfProof(proof) {
  const list = [];
  const add = (report) => {
    for (const finding of [...(report.errors ?? []), ...(report.warnings ?? [])]) {
      list.push(entry(proof.id, finding));
    }
  };
  for (const solid of proof.solids) add(solid.report ?? {});
  for (const group of proof.findings ?? []) {
    for (const finding of group.findings ?? []) list.push(entry(proof.id, finding));
    add(group.report ?? {});
  }
  return errorsFirst(list);
}

function errorsFirst(list) {
  const isError = (finding) => finding.severity === 'error';
  return [...list.filter(isError), ...list.filter((finding) => !isError(finding))];
}
