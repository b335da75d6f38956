// SPDX-License-Identifier: GPL-3.0-or-later
//
// The script of the HTML report (html_report.cpp): filters and sorts the table of findings, and
// turns a finding's picture in a dialog. The page is complete without the script.

(function() {
'use strict';

var list = document.querySelector('.findings');
var sections =
    Array.prototype.map.call(document.querySelectorAll('.findings section'), function(s) {
      return {
        element: s,
        object: s.querySelector('h3').textContent,
        body: s.querySelector('tbody'),
        rows: Array.prototype.slice.call(s.querySelectorAll('tbody tr'))
      };
    });
var total = sections.reduce(function(n, s) {
  return n + s.rows.length;
}, 0);
var search = document.getElementById('search'), code = document.getElementById('code'),
    shown = document.getElementById('shown');
var texts = null;  // of the rows of each section; made for the first search

function textsOf(section) {
  var head = section.object.toLowerCase();
  return section.rows.map(function(r) {
    return head + ' ' + r.textContent.toLowerCase();
  });
}

function filter() {
  var words = search.value.toLowerCase().split(/\s+/).filter(Boolean), want = code.value, count = 0;
  if (words.length && !texts) texts = sections.map(textsOf);
  sections.forEach(function(section, s) {
    var left = 0;
    section.rows.forEach(function(row, i) {
      var ok = (!want || row.dataset.code === want || row.dataset.severity === want) &&
          words.every(function(w) {
            return texts[s][i].indexOf(w) >= 0;
          });
      row.hidden = !ok;
      if (ok) left++;
    });
    section.element.hidden = left === 0;
    count += left;
  });
  shown.textContent = count === total ? total + ' findings' : count + ' of ' + total + ' findings';
}

function numberOf(row, key) {
  var value = row.dataset[key] || '';
  return value === '' ? -1 : +value;
}

// Sorts the rows of each object, and the objects by their first rows.
function sort(key, down) {
  var sign = down ? -1 : 1;
  var order = sections.map(function(section, i) {
    var rows = section.rows.map(function(r, k) {
      return [r, key === 'object' ? 0 : numberOf(r, key), k];
    });
    rows.sort(function(x, y) {
      return sign * (x[1] - y[1]) || x[2] - y[2];
    });
    rows.forEach(function(r) {
      section.body.appendChild(r[0]);
    });
    return [section, key === 'object' ? section.object : rows[0][1], i];
  });
  order.sort(function(x, y) {
    var d = x[1] < y[1] ? -1 : x[1] > y[1] ? 1 : 0;
    return sign * d || x[2] - y[2];
  });
  order.forEach(function(o) {
    list.appendChild(o[0].element);
  });
}

if (search) {
  search.addEventListener('input', filter);
  code.addEventListener('change', filter);
  document.querySelectorAll('.codes button').forEach(function(b) {
    b.addEventListener('click', function() {
      code.value = b.dataset.code;
      filter();
      document.getElementById('findings').scrollIntoView({behavior: 'smooth'});
    });
  });
  document.querySelectorAll('.findings th button').forEach(function(b) {
    b.addEventListener('click', function() {
      var th = b.parentNode, down = th.getAttribute('aria-sort') === 'ascending';
      document.querySelectorAll('.findings th').forEach(function(t) {
        t.removeAttribute('aria-sort');
      });
      th.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      sort(b.dataset.key, down);
    });
  });
}

var NS = 'http://www.w3.org/2000/svg', dialog = document.querySelector('dialog');
if (!dialog || !dialog.showModal) return;

var stage = dialog.querySelector('figure'), text = dialog.querySelector('.content'), scene = null,
    view = null, zoom = 1;

function triples(flat) {
  var out = [];
  for (var i = 0; i + 2 < flat.length; i += 3) out.push([flat[i], flat[i + 1], flat[i + 2]]);
  return out;
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function normal(ring) {
  var s = [0, 0, 0];
  ring.forEach(function(a, i) {
    var b = ring[(i + 1) % ring.length];
    s[0] += (a[1] - b[1]) * (a[2] + b[2]);
    s[1] += (a[2] - b[2]) * (a[0] + b[0]);
    s[2] += (a[0] - b[0]) * (a[1] + b[1]);
  });
  var n = Math.sqrt(dot(s, s)) || 1;
  return [s[0] / n, s[1] / n, s[2] / n];
}

function path(svg, style, d) {
  var p = document.createElementNS(NS, 'path');
  p.setAttribute('class', style);
  p.setAttribute('d', d);
  svg.appendChild(p);
}

function draw() {
  var a = view[0] * Math.PI / 180, e = view[1] * Math.PI / 180;
  var right = [-Math.sin(a), Math.cos(a), 0],
      up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
  var eye = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  var light = [-.35 * right[0] + .3 * eye[0], -.35 * right[1] + .3 * eye[1], .3 * eye[2] + .75],
      k = .215 * zoom;
  var c = scene.centre;
  function at(p) {
    return [
      Math.round(320 + k * (dot(p, right) - dot(c, right))),
      Math.round(240 - k * (dot(p, up) - dot(c, up)))
    ];
  }
  function trace(rings, end) {
    return rings
        .map(function(r) {
          return 'M' + r.map(function(p) {
                          return at(p).join(' ');
                        }).join('L') +
              end;
        })
        .join('');
  }
  var svg = document.createElementNS(NS, 'svg');
  svg.setAttribute('viewBox', '0 0 640 480');
  var faces = scene.facets.map(function(f) {
    var ring = f.rings[0], depth = 0;
    ring.forEach(function(p) {
      depth += dot(p, eye);
    });
    var style = f.role === 1 ? 'a' : f.role === 2 ? 'b' : '';
    if (!style) {
      var s = dot(f.normal, light);
      style = dot(f.normal, eye) < 0 ? 'k' :
          s > .75                    ? 'n4' :
          s > .45                    ? 'n3' :
          s > .15                    ? 'n2' :
                                       'n1';
    }
    return {f: f, depth: depth / ring.length, style: style};
  });
  faces.sort(function(x, y) {
    return (x.style !== 'k') - (y.style !== 'k') || x.depth - y.depth;
  });
  faces.forEach(function(x) {
    path(svg, x.style, trace(x.f.rings, 'Z'));
  });
  faces.forEach(function(x) {
    if (x.f.role) path(svg, x.f.role === 1 ? 'oa' : 'ob', trace(x.f.rings, 'Z'));
  });
  if (scene.lines.length) path(svg, 'l', trace(scene.lines, ''));
  if (scene.witness) {
    var w = at(scene.witness);
    [['h', 22], ['w', 8]].forEach(function(m) {
      var o = document.createElementNS(NS, 'circle');
      o.setAttribute('class', m[0]);
      o.setAttribute('cx', w[0]);
      o.setAttribute('cy', w[1]);
      o.setAttribute('r', m[1]);
      svg.appendChild(o);
    });
  }
  stage.replaceChildren(svg);
}

function open(row, data) {
  var raw = JSON.parse(data);
  scene = {
    facets: raw.f
                .map(function(f) {
                  var rings = f.slice(1).map(triples);
                  return {role: f[0], rings: rings, normal: normal(rings[0] || [])};
                })
                .filter(function(f) {
                  return f.rings.length && f.rings[0].length;
                }),
    lines: raw.l.map(triples),
    witness: raw.w ? triples(raw.w)[0] : null,
    centre: [0, 0, 0]
  };
  view = raw.v.slice();
  zoom = 1;
  text.replaceChildren(row.closest('section').querySelector('h3').cloneNode(true));
  row.querySelectorAll('td:not(.pic)').forEach(function(td) {
    var d = document.createElement('div');
    Array.prototype.forEach.call(td.childNodes, function(n) {
      d.appendChild(n.cloneNode(true));
    });
    text.appendChild(d);
  });
  text.querySelectorAll('details').forEach(function(d) {
    d.open = true;
  });
  draw();
  dialog.showModal();
}

document.querySelectorAll('figure[data-scene]').forEach(function(f) {
  function show() {
    open(f.closest('tr'), f.dataset.scene);
  }
  f.addEventListener('click', show);
  f.addEventListener('keydown', function(ev) {
    if (ev.key === 'Enter' || ev.key === ' ') {
      ev.preventDefault();
      show();
    }
  });
});

var last = null;
stage.addEventListener('pointerdown', function(ev) {
  last = [ev.clientX, ev.clientY];
  stage.setPointerCapture(ev.pointerId);
});
stage.addEventListener('pointermove', function(ev) {
  if (!last) return;
  view[0] -= (ev.clientX - last[0]) * .5;
  view[1] = Math.max(-90, Math.min(90, view[1] + (ev.clientY - last[1]) * .5));
  last = [ev.clientX, ev.clientY];
  draw();
});
['pointerup', 'pointercancel'].forEach(function(t) {
  stage.addEventListener(t, function() {
    last = null;
  });
});

stage.addEventListener('wheel', function(ev) {
  ev.preventDefault();
  var old = zoom;
  zoom = Math.max(.5, Math.min(60, zoom * Math.pow(1.0015, -ev.deltaY)));
  if (scene.witness) {
    var s = 1 - Math.min(1, Math.max(0, 1 / zoom));
    scene.centre = scene.witness.map(function(v) {
      return v * s;
    });
  }
  if (zoom !== old) draw();
}, {passive: false});

dialog.querySelector('.close').addEventListener('click', function() {
  dialog.close();
});
dialog.addEventListener('click', function(ev) {
  if (ev.target === dialog) dialog.close();
});
}());
