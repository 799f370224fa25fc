//! The style sheet of the page: one column on a phone, pictures in pairs if there is room, light and dark.

/// All of it.
pub const CSS: &str = r"
:root { color-scheme: light dark; --page: #fbfaf8; --card: #fff; --ink: #1d1f23; --soft: #5d636e; --line: #dfdcd6;
  --series0: #2468b2; --series1: #d07a1c; --series2: #4d8f57; --mark: #7a3fb5; --bad: #b3261e; --good: #2e7d46; }
@media (prefers-color-scheme: dark) { :root { --page: #15171b; --card: #1d2026; --ink: #e8e6e1; --soft: #a0a6b1;
  --line: #343944; --series0: #6ea8ea; --series1: #eda552; --series2: #84c48d; --mark: #c3a0f5; --bad: #ff8a80; --good: #7fd19a; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, -apple-system, 'Segoe UI', Roboto,
  'DejaVu Sans', sans-serif; }
main { max-width: 66rem; margin: 0 auto; padding: 1.25rem 1rem 4rem; }
h1 { font-size: 1.6rem; line-height: 1.2; margin: .5rem 0; text-wrap: balance; }
h2 { font-size: 1.3rem; margin: 2.75rem 0 .5rem; padding-top: .75rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.05rem; margin: 1.75rem 0 .25rem; }
p { margin: .4rem 0 .8rem; max-width: 44rem; }
.soft, .caption { color: var(--soft); font-size: .9rem; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(9.5rem, 1fr)); gap: .75rem; margin: 1rem 0; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: .6rem; padding: .75rem .9rem; }
.card b { display: block; font-size: 1.9rem; line-height: 1.1; font-variant-numeric: tabular-nums; }
.card span { display: block; font-size: .85rem; color: var(--soft); margin-top: .3rem; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 21rem), 1fr)); gap: .75rem; margin: .75rem 0; }
.pair > div { background: var(--card); border: 1px solid var(--line); border-radius: .6rem; padding: .7rem; }
svg { display: block; width: 100%; height: auto; }
svg text { fill: var(--ink); font: 11.5px system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif;
  font-variant-numeric: tabular-nums; }
svg .name { font-weight: 600; font-size: 12.5px; }
svg .tick { fill: var(--soft); font-size: 11px; }
svg .grid { stroke: var(--line); stroke-width: 1; }
svg .base { stroke: var(--ink); stroke-width: 1; }
svg .paper { stroke: var(--mark); stroke-width: 1.5; stroke-dasharray: 4 3; }
svg .papertext { fill: var(--mark); font-size: 11px; }
svg .value { stroke: var(--card); stroke-width: 3px; stroke-linejoin: round; paint-order: stroke; }
svg .series0, .key0 { fill: var(--series0); background: var(--series0); }
svg .series1, .key1 { fill: var(--series1); background: var(--series1); }
svg .series2, .key2 { fill: var(--series2); background: var(--series2); }
svg .band { fill: var(--series0); stroke: var(--series0); stroke-width: 1; stroke-linejoin: round; }
.key { display: inline-block; width: .8em; height: .8em; border-radius: 2px; margin: 0 .35em 0 .9em; }
.keymark { display: inline-block; height: 1em; border-left: 2px dashed var(--mark); margin: 0 .35em 0 .9em; vertical-align: -.15em; }
.wide { overflow-x: auto; margin: .75rem 0; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
.caption { margin: 0 0 .3rem; }
thead tr:first-child th { text-align: center; }
th, td { padding: .22rem .55rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
td.words { white-space: normal; text-wrap: balance; }
th { font-weight: 600; }
thead tr:last-child th { border-bottom: 1.5px solid var(--ink); }
.split { border-left: 1px solid var(--line); }
tr.then td { color: var(--mark); }
tr.base td { color: var(--soft); }
td b { font-weight: 650; }
.good { color: var(--good); } .bad { color: var(--bad); font-weight: 600; }
.note { border-left: 3px solid var(--series1); padding: .3rem .8rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .25rem 1rem; margin: .5rem 0; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
code { font-size: .9em; }
@media (max-width: 30rem) { th, td { padding: .22rem .22rem; } table { font-size: .74rem; } dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: .5rem; } }
";
