#pragma once

namespace hitchview::app {

/// What a calibration report has beyond the style sheet of all reports.
inline constexpr const char* kCalibReportStyle = R"(
.badge { font-size: .8rem; font-weight: 600; border: 1.5px solid; border-radius: .4rem;
  padding: .05rem .45rem; vertical-align: middle; white-space: nowrap; color: var(--soft); }
.badge.good { color: var(--good); } .badge.poor { color: var(--poor); }
.reasons { color: var(--poor); margin: .2rem 0; padding-left: 1.2rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(24rem, 100%), 1fr)); gap: 0 2rem; }
table { min-width: 0; width: 100%; }
td, th { text-align: left; vertical-align: top; }
td { overflow-wrap: break-word; padding-right: .6rem; }
.pair table { font-size: .92rem; }
.bars { width: 30%; } .bar { background: var(--first); height: .7rem; margin-top: .4rem;
  min-width: 1px; print-color-adjust: exact; }
.map { display: block; } .map svg { border: 1px solid var(--rule); }
.frame { stroke: var(--rule); fill: none; }
.cell { stroke: var(--rule); } .covered { fill: var(--first); } .uncertain { fill: var(--second); }
.empty { fill: var(--page); }
.cell + text { fill: var(--ink); font-size: 11px; }
.vector { stroke: var(--second); stroke-width: 1.2; } .seen { fill: var(--first); }
.ruler { stroke: var(--ink); stroke-width: 2.5; }
.node { fill: var(--first); } .look { stroke: var(--second); stroke-width: 1.5; }
.edge { stroke: var(--first); stroke-width: 1.5; stroke-opacity: .6; }
.edge.poor { stroke: var(--poor); stroke-dasharray: 6 4; stroke-opacity: 1; }
.provenance td { overflow-wrap: anywhere; font-size: .85rem; }
@media print { body { max-width: none; padding: 0; font-size: 11pt; } section { break-before: auto; }
  figure, tr { break-inside: avoid; } svg, .bar { print-color-adjust: exact; } }
)";

}  // namespace hitchview::app
