// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html_page.h"

#include "base/json_text.h"

namespace watertight::report {
namespace {

constexpr char kStyle[] = R"css(
:root{color-scheme:light dark;--page:#f5f6f8;--card:#fff;--ink:#1b2430;--soft:#5b6776;--line:#dfe4ea;
--accent:#1f5fbf;--good:#1d8a52;--bad:#c8283c;--open:#b57400;--sky1:#eef3f9;--sky2:#dbe5f0;
--n1:#7e92a8;--n2:#9db0c4;--n3:#bccbda;--n4:#d9e3ed;--back:#8799ac;--edge:#3c4d60;
--a:#e5243b;--b:#f59a23;--w:#7a00cc}
@media(prefers-color-scheme:dark){:root{--page:#12161c;--card:#1b212a;--ink:#e7ecf2;--soft:#9aa7b6;
--line:#2d3642;--accent:#7db2ff;--good:#4cc38a;--bad:#ff6b7a;--open:#f0b03f;--sky1:#222b37;--sky2:#161c25;
--n1:#39485a;--n2:#4a5c71;--n3:#5e7289;--n4:#778da5;--back:#2f3b49;--edge:#c3d0dd;
--a:#ff4d61;--b:#ffae3d;--w:#d58bff}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
main{max-width:1240px;margin:0 auto;padding:24px 20px 60px}
h1{font-size:1.6rem;line-height:1.2;margin:0;letter-spacing:-.01em}
h2{font-size:1.1rem;margin:34px 0 12px}
code,.num{font-variant-numeric:tabular-nums}
code{font:.86em ui-monospace,SFMono-Regular,Menlo,Consolas,monospace;overflow-wrap:anywhere}
.soft{color:var(--soft)}
header{display:flex;flex-wrap:wrap;gap:6px 24px;align-items:baseline;justify-content:space-between;margin-bottom:18px}
.banner{display:flex;gap:16px;align-items:center;border-radius:14px;padding:18px 22px;color:#fff;font-size:1.2rem;font-weight:600}
.banner.valid{background:#1d7a4b}.banner.invalid{background:#b3243a}.banner.undecided{background:#946200}
.banner svg{width:38px;height:38px;flex:none}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(300px,1fr));gap:16px;margin-top:16px}
.card{background:var(--card);border:1px solid var(--line);border-radius:14px;padding:16px 18px}
.card h3{margin:0 0 8px;font-size:.8rem;letter-spacing:.06em;text-transform:uppercase;color:var(--soft)}
.big{font-size:1.9rem;font-weight:650;line-height:1.1}
.bar{display:flex;height:10px;border-radius:5px;overflow:hidden;background:var(--line);margin:10px 0 8px}
.bar i{display:block}.valid>.dot,.bar .valid,.dot.valid{background:var(--good)}
.bar .invalid,.dot.invalid{background:var(--bad)}.bar .undecided,.dot.undecided{background:var(--open)}
.dot{display:inline-block;width:9px;height:9px;border-radius:50%;margin-right:6px}
.legend{display:flex;flex-wrap:wrap;gap:2px 16px;color:var(--soft)}.legend b{color:var(--ink)}
.map svg{width:100%;height:min(300px,60vw);display:block;margin-bottom:8px}
.map path{fill:none;stroke-linecap:round;stroke-width:5;vector-effect:non-scaling-stroke}
.map .valid{stroke:var(--n2)}.map .invalid{stroke:var(--bad)}.map .undecided{stroke:var(--open)}
table{border-collapse:collapse;width:100%}
.codes td{padding:3px 8px 3px 0;vertical-align:middle}
.codes button{all:unset;cursor:pointer;color:var(--accent);font-weight:600}
.codes button:hover,.codes button:focus-visible{text-decoration:underline}
.codes .track{width:34%;min-width:60px}
.codes .track i{display:block;height:10px;border-radius:3px;background:var(--bad);min-width:3px}
.codes .warning .track i{background:var(--open)}
.codes .name{font-size:.8rem;overflow-wrap:anywhere}
.tools{display:flex;flex-wrap:wrap;gap:10px;align-items:center;margin-bottom:10px}
.tools input,.tools select{font:inherit;color:inherit;background:var(--card);border:1px solid var(--line);border-radius:9px;padding:7px 11px}
.tools input{flex:1 1 220px;min-width:0}
.findings{background:var(--card);border:1px solid var(--line);border-radius:14px;overflow:hidden}
.findings th{font-size:.78rem;text-align:left;color:var(--soft);padding:10px 12px;border-bottom:1px solid var(--line);white-space:nowrap}
.findings th button{all:unset;cursor:pointer}.findings th button:hover,.findings th button:focus-visible{color:var(--accent)}
.findings th[aria-sort=ascending] button::after{content:" \25B4"}.findings th[aria-sort=descending] button::after{content:" \25BE"}
.findings td{padding:10px 12px;vertical-align:top;border-bottom:1px solid var(--line)}
.findings tbody tr:last-child td{border-bottom:0}
.findings tbody tr:hover{background:color-mix(in srgb,var(--accent) 6%,transparent)}
.findings td p{margin:0 0 3px}
.pic{width:172px}
figure{margin:0;border-radius:10px;background:linear-gradient(var(--sky1),var(--sky2));overflow:hidden;cursor:zoom-in}
figure svg{display:block;width:100%;height:auto}
.none{display:grid;place-items:center;height:72px;border-radius:10px;background:var(--sky1);color:var(--soft);font-size:.78rem;text-align:center;padding:0 10px}
svg path{stroke-linejoin:round;fill-rule:evenodd}
.k,.n1,.n2,.n3,.n4{stroke:var(--edge);stroke-width:1.6;stroke-opacity:.55}
.k{fill:var(--back);fill-opacity:.9;stroke-opacity:.35}.n1{fill:var(--n1)}.n2{fill:var(--n2)}.n3{fill:var(--n3)}.n4{fill:var(--n4)}
.n1,.n2,.n3,.n4{fill-opacity:.72}
.a{fill:var(--a);fill-opacity:.88;stroke:var(--a);stroke-width:3}
.b{fill:var(--b);fill-opacity:.85;stroke:var(--b);stroke-width:3}
.oa,.ob{fill:none;stroke-width:3;stroke-dasharray:9 7}.oa{stroke:var(--a)}.ob{stroke:var(--b)}
.l{fill:none;stroke:var(--w);stroke-width:6;stroke-linecap:round}
.h{fill:none;stroke:var(--w);stroke-width:4}.w{fill:var(--w);stroke:#fff;stroke-width:3}
.code{display:inline-block;padding:1px 9px;border-radius:99px;font-weight:650;color:#fff;background:var(--bad)}
.warning .code{background:var(--open);color:#fff}
@media(prefers-color-scheme:dark){.code,.warning .code{color:#14181e}}
.tag{display:inline-block;border:1px solid var(--line);border-radius:99px;padding:0 8px;font-size:.78rem;color:var(--soft)}
.hint{color:var(--soft)}.hint::before{content:"\2192\00a0"}
details summary{cursor:pointer;color:var(--soft);font-size:.82rem}
.facts{display:grid;grid-template-columns:auto 1fr;gap:2px 14px;margin:0}.facts dt{color:var(--soft)}.facts dd{margin:0;overflow-wrap:anywhere}
dialog{border:0;border-radius:16px;padding:0;width:min(980px,96vw);max-height:94vh;background:var(--card);color:inherit;box-shadow:0 24px 80px #0008}
dialog::backdrop{background:#0009}
dialog figure{border-radius:0;cursor:grab;touch-action:none}dialog figure:active{cursor:grabbing}
dialog figure svg{max-height:64vh}
dialog .text{padding:14px 20px 20px}dialog .text p{margin:0 0 4px}dialog .close{position:absolute;top:10px;right:10px;font:inherit;border:1px solid var(--line);border-radius:9px;background:var(--card);color:inherit;padding:5px 12px;cursor:pointer}
footer{margin-top:34px;color:var(--soft);font-size:.86rem}
.key{display:inline-block;width:12px;height:12px;border-radius:3px;vertical-align:-1px;margin-right:5px}
[hidden]{display:none!important}
@media(max-width:760px){main{padding:16px 12px 40px}.findings thead{display:none}
.findings tr{display:grid;grid-template-columns:112px 1fr;gap:4px 12px;padding:12px;border-bottom:1px solid var(--line)}
.findings td{display:block;padding:0;border:0;grid-column:2;min-width:0}.findings td.pic{grid-column:1;grid-row:1/span 4;width:auto}
.banner{font-size:1.05rem;padding:14px 16px}}
@media print{figure{break-inside:avoid}.tools,dialog{display:none}body{background:#fff}}
)css";

constexpr char kScript[] = R"js(
(function(){
'use strict';
var rows=Array.prototype.slice.call(document.querySelectorAll('.findings tbody tr'));
var search=document.getElementById('search'),code=document.getElementById('code'),shown=document.getElementById('shown');
var texts=rows.map(function(r){return r.textContent.toLowerCase();});
function filter(){
  var words=search.value.toLowerCase().split(/\s+/).filter(Boolean),want=code.value,count=0;
  rows.forEach(function(row,i){
    var ok=(!want||row.dataset.code===want||row.dataset.severity===want)&&
      words.every(function(w){return texts[i].indexOf(w)>=0;});
    row.hidden=!ok;if(ok)count++;
  });
  shown.textContent=count===rows.length?rows.length+' findings':count+' of '+rows.length+' findings';
}
if(search){
  search.addEventListener('input',filter);code.addEventListener('change',filter);
  document.querySelectorAll('.codes button').forEach(function(b){b.addEventListener('click',function(){
    code.value=b.dataset.code;filter();document.getElementById('findings').scrollIntoView({behavior:'smooth'});});});
  document.querySelectorAll('.findings th button').forEach(function(b){b.addEventListener('click',function(){
    var th=b.parentNode,down=th.getAttribute('aria-sort')==='ascending',key=b.dataset.key,body=rows.length?rows[0].parentNode:null;
    document.querySelectorAll('.findings th').forEach(function(t){t.removeAttribute('aria-sort');});
    th.setAttribute('aria-sort',down?'descending':'ascending');
    var order=rows.map(function(r,i){return[r,i];});
    order.sort(function(x,y){
      var a=x[0].dataset[key]||'',c=y[0].dataset[key]||'',d;
      if(key==='object')d=a<c?-1:a>c?1:0;
      else d=(a===''?-1:+a)-(c===''?-1:+c);
      return(down?-d:d)||x[1]-y[1];});
    if(body)order.forEach(function(o){body.appendChild(o[0]);});
  });});
}
var NS='http://www.w3.org/2000/svg',dialog=document.querySelector('dialog');
if(!dialog||!dialog.showModal)return;
var stage=dialog.querySelector('figure'),text=dialog.querySelector('.content'),scene=null,view=null,zoom=1;
function triples(flat){var out=[];for(var i=0;i+2<flat.length;i+=3)out.push([flat[i],flat[i+1],flat[i+2]]);return out;}
function dot(a,b){return a[0]*b[0]+a[1]*b[1]+a[2]*b[2];}
function normal(ring){
  var s=[0,0,0];ring.forEach(function(a,i){var b=ring[(i+1)%ring.length];
    s[0]+=(a[1]-b[1])*(a[2]+b[2]);s[1]+=(a[2]-b[2])*(a[0]+b[0]);s[2]+=(a[0]-b[0])*(a[1]+b[1]);});
  var n=Math.sqrt(dot(s,s))||1;return[s[0]/n,s[1]/n,s[2]/n];}
function path(svg,style,d){var p=document.createElementNS(NS,'path');p.setAttribute('class',style);p.setAttribute('d',d);svg.appendChild(p);}
function draw(){
  var a=view[0]*Math.PI/180,e=view[1]*Math.PI/180;
  var right=[-Math.sin(a),Math.cos(a),0],up=[-Math.sin(e)*Math.cos(a),-Math.sin(e)*Math.sin(a),Math.cos(e)];
  var eye=[Math.cos(e)*Math.cos(a),Math.cos(e)*Math.sin(a),Math.sin(e)];
  var light=[-.35*right[0]+.3*eye[0],-.35*right[1]+.3*eye[1],.3*eye[2]+.75],k=.215*zoom;
  var c=scene.centre;
  function at(p){return[Math.round(320+k*(dot(p,right)-dot(c,right))),Math.round(240-k*(dot(p,up)-dot(c,up)))];}
  function trace(rings,end){return rings.map(function(r){return'M'+r.map(function(p){return at(p).join(' ');}).join('L')+end;}).join('');}
  var svg=document.createElementNS(NS,'svg');svg.setAttribute('viewBox','0 0 640 480');
  var faces=scene.facets.map(function(f){
    var ring=f.rings[0],depth=0;ring.forEach(function(p){depth+=dot(p,eye);});
    var style=f.role===1?'a':f.role===2?'b':'';
    if(!style){var s=dot(f.normal,light);style=dot(f.normal,eye)<0?'k':s>.75?'n4':s>.45?'n3':s>.15?'n2':'n1';}
    return{f:f,depth:depth/ring.length,style:style};});
  faces.sort(function(x,y){return(x.style!=='k')-(y.style!=='k')||x.depth-y.depth;});
  faces.forEach(function(x){path(svg,x.style,trace(x.f.rings,'Z'));});
  faces.forEach(function(x){if(x.f.role)path(svg,x.f.role===1?'oa':'ob',trace(x.f.rings,'Z'));});
  if(scene.lines.length)path(svg,'l',trace(scene.lines,''));
  if(scene.witness){var w=at(scene.witness);[['h',22],['w',8]].forEach(function(m){
    var o=document.createElementNS(NS,'circle');o.setAttribute('class',m[0]);o.setAttribute('cx',w[0]);o.setAttribute('cy',w[1]);o.setAttribute('r',m[1]);svg.appendChild(o);});}
  stage.replaceChildren(svg);
}
function open(row,data){
  var raw=JSON.parse(data);
  scene={facets:raw.f.map(function(f){var rings=f.slice(1).map(triples);return{role:f[0],rings:rings,normal:normal(rings[0]||[])};}).filter(function(f){return f.rings.length&&f.rings[0].length;}),
    lines:raw.l.map(triples),witness:raw.w?triples(raw.w)[0]:null,centre:[0,0,0]};
  view=raw.v.slice();zoom=1;
  text.replaceChildren();
  row.querySelectorAll('td:not(.pic)').forEach(function(td){var d=document.createElement('div');
    Array.prototype.forEach.call(td.childNodes,function(n){d.appendChild(n.cloneNode(true));});text.appendChild(d);});
  text.querySelectorAll('details').forEach(function(d){d.open=true;});
  draw();dialog.showModal();
}
document.querySelectorAll('figure[data-scene]').forEach(function(f){
  function show(){open(f.closest('tr'),f.dataset.scene);}
  f.addEventListener('click',show);
  f.addEventListener('keydown',function(ev){if(ev.key==='Enter'||ev.key===' '){ev.preventDefault();show();}});
});
var last=null;
stage.addEventListener('pointerdown',function(ev){last=[ev.clientX,ev.clientY];stage.setPointerCapture(ev.pointerId);});
stage.addEventListener('pointermove',function(ev){if(!last)return;
  view[0]-=(ev.clientX-last[0])*.5;view[1]=Math.max(-90,Math.min(90,view[1]+(ev.clientY-last[1])*.5));
  last=[ev.clientX,ev.clientY];draw();});
['pointerup','pointercancel'].forEach(function(t){stage.addEventListener(t,function(){last=null;});});
stage.addEventListener('wheel',function(ev){ev.preventDefault();var old=zoom;
  zoom=Math.max(.5,Math.min(60,zoom*Math.pow(1.0015,-ev.deltaY)));
  if(scene.witness){var s=1-Math.min(1,Math.max(0,1/zoom));scene.centre=scene.witness.map(function(v){return v*s;});}
  if(zoom!==old)draw();},{passive:false});
dialog.querySelector('.close').addEventListener('click',function(){dialog.close();});
dialog.addEventListener('click',function(ev){if(ev.target===dialog)dialog.close();});
}());
)js";

}  // namespace

std::string html_text(std::string_view text) {
  std::string html;
  html.reserve(text.size());
  const std::string clean = utf8_text(text);
  for (const char c : clean) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

void append(std::string& html, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) html += part;
}

std::string_view page_style() { return kStyle; }
std::string_view page_script() { return kScript; }

}  // namespace watertight::report
