// The style sheet.
#include "page/style.h"

namespace palpate::page {

const char* style() {
  return R"css(
:root { color-scheme: light dark; --back: #ffffff; --ink: #1b1f24; --soft: #57606a;
  --line: #d0d7de; --card: #f6f8fa; --link: #0b5cad; }
@media (prefers-color-scheme: dark) { :root { --back: #14171a; --ink: #e6e8eb; --soft: #a2abb5;
  --line: #3a424b; --card: #1e2329; --link: #7cb7ff; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem 1.2rem 3rem; max-width: 62rem; background: var(--back);
  color: var(--ink); font: 1rem/1.55 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: .2rem 0 .6rem; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 .6rem; padding-top: .6rem;
  border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.4rem 0 .3rem; }
a { color: var(--link); } a:focus-visible, summary:focus-visible, .wide:focus-visible,
input:focus-visible { outline: 3px solid var(--link); outline-offset: 2px; }
.skip { position: absolute; left: -999rem; } .skip:focus { position: static; }
.kind { color: var(--soft); margin: 0; }
.big { font-size: 2rem; font-weight: 600; line-height: 1.2; }
.big span { font-size: 1.3rem; font-weight: 400; }
.answer { background: var(--card); border-left: .35rem solid var(--link); padding: .6rem 1rem;
  font-size: 1.08rem; } .answer p { margin: .35rem 0; }
nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; }
figure { margin: 1rem 0 1.6rem; break-inside: avoid; }
figcaption, caption { color: var(--soft); text-align: left; padding: .3rem 0; font-size: .95rem; }
figure svg { display: block; width: 100%; min-width: 34rem; max-width: 51rem; height: auto; }
.sheet { overflow-x: auto; }
@media screen and (max-width: 37rem) {
  .sheet::before { content: "Slide the figure sideways to see all of it."; color: var(--soft); font-size: .9rem; } }
.white { background: #ffffff; border-radius: .4rem; }
@media (prefers-color-scheme: dark) { .plot svg { filter: invert(.91) hue-rotate(180deg); } }
.maps { display: flex; flex-wrap: wrap; gap: 1.2rem; } .maps figure { margin: 0; width: 17rem; }
.maps img { width: 100%; display: block; height: auto; image-rendering: pixelated; border: 1px solid var(--line); }
.bar { display: flex; justify-content: space-between; font-size: .9rem; }
.maps .scale { height: .9rem; image-rendering: auto; }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { border-bottom: 1px solid var(--line); padding: .25rem .8rem .25rem 0; text-align: left;
  vertical-align: top; } th { font-weight: 600; } .number { text-align: right; }
.words { min-width: 24rem; }
code, pre { font: .92em/1.45 ui-monospace, monospace; } pre { background: var(--card);
  padding: .8rem; overflow-x: auto; overflow-wrap: normal; } code { background: var(--card); }
summary { cursor: pointer; } summary h2 { display: inline-block; border: 0; margin: .4rem 0; padding: 0; }
section + section > details:first-child { border-top: 1px solid var(--line); }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(16rem, 1fr)); gap: 1.2rem; }
.cards section, .cards p { margin: 0; } .cards h3 { margin: .3rem 0; } .cards figure { margin: 0; }
.whole svg, .cards svg { min-width: 0; } .whole .sheet::before, .cards .sheet::before { content: none; }
.whole .words { min-width: 0; white-space: normal; } .answer td { white-space: nowrap; } .whole table { width: 100%; }
@media screen and (max-width: 37rem) { .whole thead { display: none; }
  .whole tr, .whole th, .whole td { display: block; } .whole tr { border-bottom: 1px solid var(--line); }
  .whole th, .whole td { border: 0; padding: .1rem 0; text-align: left; } } footer { color: var(--soft); margin-top: 2rem; font-size: .9rem; }
.turn { display: flex; flex-wrap: wrap; gap: 1rem; align-items: center; }
.turn label { display: flex; gap: .5rem; align-items: center; } canvas { max-width: 100%; }
@media print { nav, .skip, .turn { display: none; } body { max-width: none; padding: 0; }
  .wide, .sheet, pre { overflow: visible; } pre { white-space: pre-wrap; }
  figure svg { min-width: 0; } details:not([open]) { display: none; } }
)css";
}

}  // namespace palpate::page
