// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/page.hpp"

namespace handcast::report {

const char* const kStyle = R"css(
section#headline { margin-top: 2rem; }
.cards { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1rem; margin-bottom: .8rem; }
.card { background: var(--panel); border: 1px solid var(--line); border-top: 3px solid var(--hue); border-radius: 6px; padding: 1rem 1.1rem .6rem; }
.card h3 { margin: 0; }
.card p { margin: 0 0 .5rem; font-size: .92rem; }
.card .big { font-size: 2.2rem; font-weight: 640; line-height: 1.2; font-variant-numeric: tabular-nums; }
.baseline { --hue: var(--baseline); }
.paper { --hue: var(--cascade); }
.handcast { --hue: var(--ours); }

video { display: block; width: 100%; background: #101010; border-radius: 6px; }
.strip { display: grid; grid-template-columns: repeat(5, minmax(150px, 1fr)); gap: 6px; overflow-x: auto; }
.strip img { display: block; width: 100%; border-radius: 4px; }
h3.baseline, h3.paper, h3.handcast { color: var(--hue); }

.accuracy thead th[class] { color: var(--hue); }
.accuracy .figures th { white-space: normal; }
.reading td { padding: 0 0 .55rem; text-align: left; white-space: normal; color: var(--quiet); font-size: .86rem; }

svg { display: block; width: 100%; min-width: 420px; margin: .3rem 0 1rem; }
svg rect { fill: var(--hue); }
svg text { fill: var(--quiet); font-size: 11px; text-anchor: middle; }
svg text.axis { fill: var(--ink); font-size: 12px; }
svg line { stroke: var(--line); }
.legend { font-size: .9rem; }
.key { margin-right: 1.2rem; }
.key::before { content: ""; display: inline-block; width: .7em; height: .7em; margin-right: .4em; border-radius: 2px; background: var(--hue); }

.stage { display: grid; grid-template-columns: 5.5rem 1fr; align-items: center; padding: .3rem 0; border-top: 1px solid var(--line); }
.stage b { font-weight: 500; }
.bar { display: grid; grid-template-columns: 5.2rem 1fr 8.5rem; align-items: center; gap: .6rem; font-size: .85rem; line-height: 1.5; }
.who, .value small { color: var(--quiet); }
.value { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.track { position: relative; height: .55rem; border-radius: 3px; background: var(--line); overflow: hidden; }
.track i { position: absolute; inset: 0 auto 0 0; border-radius: 3px; background: var(--ours); }
.track .p99 { opacity: .35; }

@media (max-width: 640px) {
  .cards { grid-template-columns: 1fr; }
  .stage { grid-template-columns: 1fr; }
  .bar { grid-template-columns: 4.6rem 1fr 6.6rem; gap: .4rem; }
}
@media print {
  video { display: none; }
}
)css";

}  // namespace handcast::report
