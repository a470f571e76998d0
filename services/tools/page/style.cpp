// SPDX-License-Identifier: Apache-2.0
#include "services/tools/page/style.hpp"

namespace handcast::page {

const char* const kStyle = R"css(
:root {
  color-scheme: light dark;
  --paper: #fbfaf8; --ink: #22252a; --quiet: #686d76; --line: #e2dfd9; --panel: #ffffff;
  --baseline: #8d939c; --cascade: #c58a2c; --ours: #14806a;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #16181b; --ink: #e4e3e0; --quiet: #989da6; --line: #2e3238; --panel: #1d2024;
    --baseline: #7d848e; --cascade: #d7a14a; --ours: #3fb899;
  }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); font: 16px/1.55 system-ui, -apple-system, "Segoe UI", "Noto Sans", sans-serif; }
main { max-width: 980px; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; font-weight: 650; letter-spacing: -0.01em; margin: 0 0 1rem; }
h2 { font-size: 1.25rem; font-weight: 640; margin: 0 0 .5rem; }
h3 { font-size: .95rem; font-weight: 620; margin: 1.4rem 0 .3rem; }
p { margin: 0 0 .8rem; }
section { margin-top: 3rem; }
.quiet, .unit, dt { color: var(--quiet); }
.quiet { font-size: .9rem; }
.unit { font-weight: 400; font-size: .85em; }
.missing { color: var(--quiet); border-left: 3px solid var(--line); padding-left: .8rem; }
dl { display: flex; flex-wrap: wrap; gap: .4rem 2rem; margin: 0; font-size: .9rem; }
dd { margin: 0; overflow-wrap: anywhere; }

.wide { overflow-x: auto; margin-bottom: 1rem; }
table { width: 100%; border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .6rem; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
thead th { font-size: .85rem; font-weight: 600; color: var(--quiet); border-bottom: 1px solid var(--line); }
thead th[colspan] { text-align: center; }
tbody th { font-weight: 500; }
tbody tr + tr:not(.reading) > * { border-top: 1px solid var(--line); }
td.best { font-weight: 750; }

@media (max-width: 640px) {
  main { padding: 1.5rem 1rem 3rem; }
  h1 { font-size: 1.5rem; }
  th, td { padding: .3rem .4rem; }
}
)css";

}  // namespace handcast::page
