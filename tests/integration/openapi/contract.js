// SPDX-License-Identifier: GPL-3.0-or-later
// Sends requests that fast-check makes to each operation of an OpenAPI document, and checks the
// answers:
//   node contract.js URL openapi.json DOCUMENT.city.jsonl SEED RUNS    (packages are found from the
//   current folder)
// The status and the media type are among those of the operation, JSON fits its schema, and nothing
// is a defect of the service (500). The collection "town" has the document and is never changed.
// Prints the smallest request that is answered in another way; exit status 1.
import {readFileSync} from 'node:fs';
import http from 'node:http';
import {createRequire} from 'node:module';

const require = createRequire(`${process.cwd()}/`);
const fc = require('fast-check');
const Ajv = require('ajv').default;
const [url, apiFile, documentFile, seed, runs] = process.argv.slice(2);
const api = JSON.parse(readFileSync(apiFile, 'utf8'));
const document = readFileSync(documentFile, 'utf8').split('\n').slice(0, 4).join('\n');
const ids = document.split('\n').slice(1).map((line) => JSON.parse(line).id);

const ajv = new Ajv({strict: false, allErrors: false});
require('ajv-formats').default(ajv);
ajv.addSchema(api, 'api');

const escaped = (part) => part.replaceAll('~', '~0').replaceAll('/', '~1');
const at = (pointer) => pointer.split('/').slice(1).reduce(
    (value, part) => value[part.replaceAll('~1', '/').replaceAll('~0', '~')], api);
/// The place of a value, behind its $ref if it is one.
const placeOf = (pointer) => (at(pointer).$ref ? at(pointer).$ref.slice(1) : pointer);

const validators = new Map();
function validatorOf(pointer) {
  if (!validators.has(pointer))
    validators.set(pointer, ajv.compile({$ref: `api#${encodeURI(pointer)}`}));
  return validators.get(pointer);
}

const anyText = fc.oneof(
    fc.string({maxLength: 12}), fc.string({unit: 'binary', maxLength: 6}),
    fc.constantFrom(
        '', '*', '-1', '1e999', 'true', '0', '%', '..', '\'', '"', '99999999999999999999'));

/// Values that a schema allows, as texts.
function fitting(schema = {}) {
  if (schema.enum) return fc.constantFrom(...schema.enum.map(String));
  if (schema.type === 'integer')
    return fc.integer({min: schema.minimum ?? 0, max: schema.maximum ?? 1000}).map(String);
  if (schema.type === 'number') return fc.double({min: 0, max: 100, noNaN: true}).map(String);
  if (schema.type === 'boolean') return fc.boolean().map(String);
  if (schema.type === 'array') {
    return fc.array(fitting(schema.items), {minLength: schema.minItems, maxLength: schema.maxItems})
        .map((values) => values.join(','));
  }
  if (schema.format === 'uri') {
    return fc
        .constantFrom('OGC/0/CRS84h', 'OGC/1.3/CRS84', 'EPSG/0/3857', 'EPSG/0/7415', 'EPSG/0/1')
        .map((name) => `http://www.opengis.net/def/crs/${name}`);
  }
  return anyText;
}

const mostlyFitting = (schema) =>
    fc.oneof({weight: 12, arbitrary: fitting(schema)}, {weight: 1, arbitrary: anyText});

/// Ids of a collection that there is, that there is not, and texts that are none. What changes a
/// collection gets another than "town".
function pathValue(name, changes) {
  const known = name === 'collectionId' ? [changes ? 'scrap' : 'town', 'nowhere'] :
      name === 'jobId'                  ? [...jobs, 'nothing'] :
                                          [...ids, 'nothing'];
  return fc.oneof(
      {weight: 6, arbitrary: fc.constantFrom(...known)},
      {weight: 1, arbitrary: anyText.filter((text) => !['', '.', '..', 'town'].includes(text))});
}

const bodies = fc.oneof(
    fc.constant(document), fc.constant(document.split('\n')[0]),
    fc.constant(document.split('\n')[1]),
    fc.nat(document.length).map((length) => document.slice(0, length)),
    fc.tuple(fc.nat(document.length - 1), fc.string({maxLength: 3}))
        .map(([place, text]) => document.slice(0, place) + text + document.slice(place + 1)),
    fc.json(), anyText, fc.constant('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'),
    fc.constant('POLYHEDRALSURFACE Z EMPTY'), fc.constant('{"id":"scrap"}'),
    fc.constant('{"invalid":"keep"}'), fc.constant('{"attributes":["a"]}'));

function requestsOf(path, method, operation) {
  const changes = !['get', 'head'].includes(method) && path !== '/validate';
  const parts = {values: {}, query: {}, headers: {}};
  for (const given of operation.parameters ?? []) {
    const parameter = given.$ref ? at(given.$ref.slice(1)) : given;
    if (parameter.in === 'path') parts.values[parameter.name] = pathValue(parameter.name, changes);
    if (parameter.in === 'query') {
      // One of so many requests is without the parameter.
      const value = parameter.name === 'collection' ? fc.constantFrom('scrap', 'scrap', 'a b') :
                                                      mostlyFitting(parameter.schema);
      parts.query[parameter.name] =
          fc.option(value, {nil: undefined, freq: parameter.required ? 20 : 2});
    }
    if (parameter.in === 'header' && parameter.name !== 'Content-Encoding') {
      parts.headers[parameter.name] =
          fc.option(fc.constantFrom('*', '"a"', 'W/"a"', 'a', ''), {nil: undefined, freq: 2});
    }
  }
  const answers =
      Object.values(operation.responses).flatMap((response) => Object.keys(response.content ?? {}));
  parts.headers.Accept = fc.option(
      fc.constantFrom('*/*', 'text/html', 'image/png', ...answers), {nil: undefined, freq: 2});
  if (operation.requestBody) {
    const {content} = operation.requestBody.$ref ? at(operation.requestBody.$ref.slice(1)) :
                                                   operation.requestBody;
    parts.headers['Content-Type'] =
        fc.option(fc.constantFrom(...Object.keys(content), 'image/png'), {nil: undefined, freq: 4});
  }
  return fc.record({
    values: fc.record(parts.values),
    query: fc.record(parts.query),
    headers: fc.record(parts.headers),
    body: operation.requestBody ? bodies : fc.constant(undefined)
  });
}

function targetOf(path, {values, query}) {
  const filled = path.replaceAll(/\{(\w+)\}/g, (_, name) => encodeURIComponent(values[name]));
  const pairs = Object.entries(query)
                    .filter(([, value]) => value !== undefined)
                    .map(([name, value]) => `${name}=${encodeURIComponent(value)}`);
  return filled + (pairs.length > 0 ? `?${pairs.join('&')}` : '');
}

const agent = new http.Agent({keepAlive: true, maxSockets: 1});
function send(method, target, headers, body) {
  const fields =
      Object.fromEntries(Object.entries(headers).filter(([, value]) => value !== undefined));
  if (body !== undefined || ['put', 'post', 'patch'].includes(method)) {
    fields['Content-Length'] = Buffer.byteLength(body ?? '');
  }
  return new Promise((resolve, reject) => {
    const request = http.request(
        url + target, {method: method.toUpperCase(), headers: fields, agent}, (answer) => {
          const pieces = [];
          answer.on('data', (piece) => pieces.push(piece));
          answer.on('end', () => resolve({
                             status: answer.statusCode,
                             type: (answer.headers['content-type'] ?? '').split(';')[0],
                             body: Buffer.concat(pieces)
                           }));
          answer.on('error', reject);
        });
    request.on('error', reject);
    request.end(body);
  });
}

/// Why an answer does not keep the contract; nothing if it does.
function breach(pointer, operation, answer) {
  if (answer.status === 500) return `500: ${answer.body}`;
  if (!operation.responses[answer.status])
    return `status ${answer.status} is not described: ${answer.body.subarray(0, 300)}`;
  const place = placeOf(`${pointer}/responses/${answer.status}`);
  const content = at(place).content ?? {};
  if (answer.body.length === 0) return undefined;
  const type = Object.keys(content).find((known) => known.split(';')[0] === answer.type);
  if (type === undefined)
    return `${answer.status} has the type ${answer.type}, not ${Object.keys(content)}`;
  if (!/[/+]json$/.test(answer.type) || !content[type].schema) return undefined;
  const validate = validatorOf(`${place}/content/${escaped(type)}/schema`);
  if (validate(JSON.parse(answer.body))) return undefined;
  return `${answer.status} ${type}: ${ajv.errorsText(validate.errors)}: ${
      answer.body.subarray(0, 500)}`;
}

const type = {
  'Content-Type': 'application/city+json-seq'
};
await send('post', '/collections/town/items?invalid=keep', type, document);
const jobs = [];
for (let i = 0; i < 5; ++i) {
  const made = await send('post', '/jobs?collection=scrap&invalid=keep', type, document);
  jobs.push(JSON.parse(made.body).jobID);
}
let failed = 0;
for (const [path, methods] of Object.entries(api.paths)) {
  for (const [method, operation] of Object.entries(methods)) {
    await send('post', '/collections/scrap/items?invalid=keep', type, document);
    const pointer = `/paths/${escaped(path)}/${method}`;
    const statuses = new Map();
    const property = fc.asyncProperty(requestsOf(path, method, operation), async (request) => {
      const answer = await send(method, targetOf(path, request), request.headers, request.body);
      statuses.set(answer.status, (statuses.get(answer.status) ?? 0) + 1);
      const why = breach(pointer, operation, answer);
      if (why) throw new Error(`${method.toUpperCase()} ${targetOf(path, request)}: ${why}`);
    });
    const result = await fc.check(property, {seed: Number(seed), numRuns: Number(runs)});
    const counts = [...statuses].sort().map(([status, count]) => `${status}: ${count}`).join(', ');
    console.log(`${result.failed ? 'WRONG' : 'ok'}: ${method.toUpperCase()} ${path} (${counts})`);
    if (!result.failed) continue;
    ++failed;
    console.log(result.errorInstance?.message);
    console.log(fc.defaultReportMessage(result));
  }
}
process.exit(failed > 0 ? 1 : 0);
