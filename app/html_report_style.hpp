#pragma once

namespace hitchview::app {

/// Style sheet of the report: readable in light and dark, on a telephone and on paper.
inline constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --page: #fff; --ink: #1b1f24; --soft: #59636e; --rule: #d5dae0;
  --first: #0b62c4; --second: #c2410c; --muted: #9aa4af; --good: #157f3b; --poor: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --page: #14171b; --ink: #e6e9ec; --soft: #9da7b1;
  --rule: #353c44; --first: #62a8ff; --second: #ff9a5c; --muted: #77818c; --good: #55c57a;
  --poor: #ff8a80; } }
body { background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif;
  max-width: 62rem; margin: 0 auto; padding: 1.5rem; }
h1 { font-size: 1.9rem; margin: 0; }
h2 { border-top: 1px solid var(--rule); margin: 2.2rem 0 .6rem; padding-top: 1rem; }
h3 { margin: 1.4rem 0 .2rem; }
h3::first-letter { text-transform: uppercase; }
h4 { margin: 1rem 0 0; font-weight: 600; }
.lead, .none, figcaption, caption { color: var(--soft); }
table { border-collapse: collapse; margin: .8rem 0; min-width: 30rem; }
caption { text-align: left; padding-bottom: .3rem; }
th, td { padding: .3rem .9rem .3rem 0; border-bottom: 1px solid var(--rule); text-align: right;
  font-variant-numeric: tabular-nums; }
th:first-child, td:first-child { text-align: left; font-weight: normal; }
.recordings td { text-align: left; overflow-wrap: anywhere; }
.headline td { font-size: 1.15rem; }
.good { color: var(--good); } .poor { color: var(--poor); }
svg { width: 100%; height: auto; break-inside: avoid; }
svg text { fill: var(--soft); font: 12px system-ui, sans-serif; }
.grid { stroke: var(--rule); stroke-width: 1; }
.mark { stroke: var(--soft); stroke-dasharray: 5 4; }
.line { fill: none; stroke-width: 1.5; stroke-linejoin: round; stroke: var(--ink); }
.line.first { stroke: var(--first); } .line.second { stroke: var(--second); }
.line.muted { stroke: var(--muted); stroke-width: 1.2; }
.line.dashed { stroke-dasharray: 3 3; stroke-width: 1; }
.legend { margin: 0; color: var(--soft); font-size: .9rem; }
.key { margin-right: 1.2rem; border-bottom: 3px solid var(--ink); }
.key.first { border-color: var(--first); } .key.second { border-color: var(--second); }
.key.muted { border-color: var(--muted); } .key.dashed { border-bottom-style: dotted; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start; }
figure { margin: .4rem 0; flex: 0 1 auto; max-width: 100%; }
img { max-width: 100%; height: auto; display: block; }
figcaption { font-size: .9rem; padding-top: .3rem; }
dt { font-weight: 600; margin-top: .6rem; } dd { margin: 0; }
)";

}  // namespace hitchview::app
