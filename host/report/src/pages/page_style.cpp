#include "pages/page_style.h"

namespace tether::report {

const std::string_view kPageStyle = R"(
:root{color-scheme:light dark;--ground:#fff;--text:#1f2328;--soft:#59636e;--line:#d5d9de;
--band:#f4f6f8;--accent:#0072b2;--note:#fff4e5;--note-line:#d55e00;--bad:#fdecea;--bad-line:#b3261e}
@media screen and (prefers-color-scheme:dark){:root{--ground:#14171a;--text:#e6e8eb;--soft:#9aa3af;
--line:#353b42;--band:#1d2226;--accent:#56b4e9;--note:#2b2117;--note-line:#ff9a4d;--bad:#2d1917;
--bad-line:#f2857b}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--text);
font:16px/1.55 system-ui,-apple-system,"Segoe UI",Roboto,"Noto Sans",sans-serif}
main{max-width:980px;margin:0 auto;padding:1.5rem 1.25rem 4rem}
h1{font-size:1.9rem;line-height:1.2;margin:1rem 0 .3rem}
h2{font-size:1.45rem;line-height:1.25;margin:3.2rem 0 .4rem;padding-top:1.2rem;
border-top:1px solid var(--line)}
h3{font-size:1.08rem;margin:2rem 0 .5rem}
p{margin:.6rem 0}
.soft,figcaption,.notes{color:var(--soft)}
.notes,figcaption{font-size:.9rem}
.notes{margin:.3rem 0 0;padding:0;list-style:none}
nav ul{display:flex;flex-wrap:wrap;gap:.3rem 1.2rem;padding:0;list-style:none}
a{color:var(--accent)}
.answer{padding:.9rem 1.1rem;margin:1rem 0;border:1px solid var(--line);border-left:6px solid var(--accent);
background:var(--band);border-radius:0 6px 6px 0}
.answer p{margin:.35rem 0}
.answer .first{font-size:1.25rem;line-height:1.4}
.answer h2,.answer h3{border:0;margin:.9rem 0 0;padding:0;font-size:1rem}
.answer ul{margin:.2rem 0 0;padding-left:1.2rem}
:focus-visible{outline:3px solid var(--accent);outline-offset:2px}
.optimism,.problems{padding:.7rem 1rem;border-left:4px solid var(--note-line);
background:var(--note);border-radius:0 6px 6px 0;margin:.8rem 0}
.optimism p{margin:.25rem 0;font-weight:600}
.problems{background:var(--bad);border-color:var(--bad-line)}
.problems h2{border:0;margin:0;padding:0;font-size:1.1rem}
.problems ul{margin:.3rem 0;padding-left:1.2rem}
.scroll{overflow-x:auto;margin:.9rem 0 0}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.86rem;min-width:50%}
caption{text-align:left;font-weight:600;padding:0 0 .4rem}
th,td{padding:.26rem .5rem;text-align:right;white-space:nowrap;border-bottom:1px solid var(--line)}
thead th{white-space:normal;font-weight:600;vertical-align:bottom;background:var(--band)}
thead th[colspan]{text-align:center;border-left:1px solid var(--line)}
tbody th{font-weight:500}
.words{text-align:left}
td.words{white-space:normal;overflow-wrap:anywhere;min-width:7rem}
details{margin:.8rem 0;border:1px solid var(--line);border-radius:6px;padding:.5rem .9rem}
summary{cursor:pointer;font-weight:600}
figure{margin:1.1rem 0;break-inside:avoid}
figure .scroll{margin:0}
figure svg{display:block;max-width:100%;height:auto}
.plot svg{width:100%;min-width:560px}
figcaption{margin-top:.2rem}
.pair .scroll{display:flex;flex-wrap:wrap;gap:.6rem 2rem}
.pair svg{flex:1 1 300px;min-width:0}
code{overflow-wrap:anywhere;font-size:.92em}
.frames{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,330px),1fr));gap:1rem}
.frames figure{margin:0}
.frames svg{width:100%;border-radius:6px}
@media print{main{max-width:none;padding:0}h2{break-after:avoid}.scroll{overflow:visible}
.plot svg{min-width:0}table{font-size:8pt}th,td{padding:.15rem .35rem;white-space:normal}
details{border:0;padding:0}
details::details-content{content-visibility:visible;block-size:auto}}
)";

}  // namespace tether::report
