//! The style sheet.

/// Light and dark, narrow and wide, screen and paper.
pub(crate) const CSS: &str = r#"
:root{color-scheme:light dark;--paper:#fff;--sheet:#f6f8fa;--ink:#1f2328;--dim:#59636e;--rule:#d1d9e0;--good:#1a7f37;--bad:#cf222e;--warn:#9a6700;--accent:#0969da;--good-bg:#e6f6ea;--bad-bg:#ffebe9;--warn-bg:#fff6db}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,-apple-system,"Segoe UI",sans-serif}
header,main,footer{max-width:1240px;margin:0 auto;padding:0 clamp(14px,3vw,36px)}
header{padding-top:26px}
h1{font-size:clamp(1.25rem,3.4vw,1.75rem);line-height:1.25;margin:0 0 2px;overflow-wrap:anywhere}
h2{font-size:1.3rem;margin:44px 0 10px;padding-bottom:6px;border-bottom:1px solid var(--rule)}
h3{font-size:1rem;margin:0 0 6px;overflow-wrap:anywhere}
p{margin:6px 0 10px;max-width:76ch}
code,svg text{unicode-bidi:isolate}code{font:0.9em ui-monospace,SFMono-Regular,Menlo,monospace;overflow-wrap:anywhere}
.sub{color:var(--dim);margin:0 0 18px}
.verdict{display:flex;gap:18px;align-items:center;padding:16px 20px;border:2px solid;border-left-width:12px;border-radius:8px}
.verdict .symbol{font-size:2.5rem;line-height:1}
.verdict .word{font-size:1.5rem;font-weight:700;line-height:1.2;letter-spacing:.02em}
.verdict p{margin:3px 0 0;color:var(--ink)}
.agree{border-color:var(--good);background:var(--good-bg)}.agree .word,.agree .symbol{color:var(--good)}
.disagree{border-color:var(--bad);background:var(--bad-bg)}.disagree .word,.disagree .symbol{color:var(--bad)}
.infeasible,.failed,.undecided{border-color:var(--warn);background:var(--warn-bg)}
.infeasible .word,.infeasible .symbol,.failed .word,.failed .symbol,.undecided .word,.undecided .symbol{color:var(--warn)}
.failures{margin:16px 0 0;padding:14px 20px 6px;border:2px solid var(--bad);border-radius:8px}
.failures h2{margin:0 0 8px;border:0;padding:0;color:var(--bad);font-size:1.15rem}
.failures li{margin-bottom:14px}
.failures ol{padding-left:24px;margin:0}
.failures .name{font-weight:700;font-family:ui-monospace,Menlo,monospace;overflow-wrap:anywhere}
.facts{display:flex;flex-wrap:wrap;gap:2px 22px;margin:3px 0;padding:0;font-variant-numeric:tabular-nums}
.facts span b{font-weight:600}
.answers{display:grid;grid-template-columns:minmax(0,1fr);gap:14px;align-content:start}
.card{background:var(--sheet);border:1px solid var(--rule);border-radius:8px;padding:14px 18px;min-width:0}
.card h2{font-size:1rem;margin:0 0 6px;padding:0;border:0}.card p{margin:4px 0 6px}
.card .big{font-size:1.7rem;font-weight:700;line-height:1.2;margin:2px 0 4px}
.asked{margin-top:14px}
.asked-for{display:grid;gap:10px 26px;grid-template-columns:repeat(auto-fit,minmax(min(100%,340px),1fr))}
.asked-for>div{min-width:0}
.asked-for h3{font-size:.95rem;font-weight:400;margin:6px 0 2px;overflow-wrap:anywhere}
.asked-for p{font-size:.93rem}.asked-for .off b{color:var(--bad)}
.first{display:grid;gap:14px;margin-top:14px;grid-template-columns:minmax(0,1fr)}
@media(min-width:900px){.first{grid-template-columns:minmax(0,1.25fr) minmax(0,1fr)}}
.first.alone{grid-template-columns:minmax(0,1fr)}.alone .answers{grid-template-columns:repeat(auto-fit,minmax(min(100%,330px),1fr))}
.gallery{display:grid;gap:16px;grid-template-columns:repeat(auto-fit,minmax(min(100%,430px),1fr))}
figure{margin:0;background:var(--sheet);border:1px solid var(--rule);border-radius:8px;padding:12px 14px;min-width:0}
figure svg,.card svg{display:block;width:100%;height:auto;max-width:640px;margin:0 auto}
figcaption{font-size:.9rem;color:var(--dim);margin-top:8px}
figcaption b{color:var(--ink)}
.scroll{overflow-x:auto;margin:10px 0 18px}
table{border-collapse:collapse;font-size:.9rem;width:100%;font-variant-numeric:tabular-nums}
caption{text-align:left;font-weight:600;padding:6px 0}
th,td{text-align:left;padding:6px 12px 6px 0;border-bottom:1px solid var(--rule);vertical-align:top}
thead th{color:var(--dim);font-weight:600;white-space:nowrap}
td.n,th.n{text-align:right;white-space:nowrap}
td.why{min-width:250px;color:var(--dim)}
td.long{overflow-wrap:anywhere;min-width:170px}
tr.no td{background:var(--bad-bg)}
.yes{color:var(--good);font-weight:600;white-space:nowrap}.not{color:var(--bad);font-weight:700;white-space:nowrap}
.phases{display:flex;height:22px;border-radius:4px;overflow:hidden;border:1px solid var(--rule);margin:8px 0 4px}
.phases div{min-width:1px}
.key{display:flex;flex-wrap:wrap;gap:2px 16px;font-size:.85rem;color:var(--dim);padding:0;margin:0 0 14px;list-style:none}
.key i{display:inline-block;width:.8em;height:.8em;border-radius:2px;margin-right:6px;border:1px solid var(--rule)}
.p0{background:#0072b2}.p1{background:#e69f00}.p2{background:#009e73}.p3{background:#cc79a7}.p4{background:#56b4e9}.p5{background:#d55e00}.p6{background:#8c959f}
.skip{position:absolute;left:-999px}.skip:focus{left:8px;top:8px;background:var(--paper);padding:6px 10px;z-index:2}
a{color:var(--accent)}:focus-visible{outline:3px solid var(--accent);outline-offset:2px}
summary{cursor:pointer}details{margin:6px 0}.back ul,.scene ul{margin:2px 0;padding-left:18px}.back li{overflow-wrap:anywhere}
.cause{font-size:1.06rem;margin-bottom:4px}.fact{margin:8px 0 12px;overflow-wrap:anywhere}.dim,.asks{color:var(--dim)}
:target{outline:3px solid var(--warn);outline-offset:2px}
#scene{margin-top:14px}dl.scene{display:grid;grid-template-columns:max-content minmax(0,1fr);gap:4px 16px;margin:0;font-size:.93rem}
dl.scene dt{color:var(--dim)}dl.scene dd{margin:0;overflow-wrap:anywhere}dl.scene ul{list-style:none;padding:0}
.gallery>#map{grid-column:1/-1}#map svg{max-width:none}#map .bar{max-width:640px;margin:6px auto 0}
.stage{position:relative;overflow:hidden;max-width:900px;margin:0 auto;touch-action:pan-y}.stage svg{position:relative}
.stage canvas{position:absolute;inset:0;width:100%;height:100%}.stage path{vector-effect:non-scaling-stroke}
.chosen{fill:none;stroke:#fff;stroke-width:2.5;paint-order:stroke;filter:drop-shadow(0 0 1px #000)}
.tools{display:flex;flex-wrap:wrap;gap:8px;align-items:center;margin-bottom:10px}.tools[hidden]{display:none}
.tools select,.tools button{font:inherit;font-size:.9rem;padding:3px 8px;max-width:100%;color:var(--ink);background:var(--paper);border:1px solid var(--dim);border-radius:5px}
th button{all:unset;cursor:pointer;font:inherit}th button:focus-visible{outline:3px solid var(--accent)}
th[aria-sort=ascending] button::after{content:" ▲"}th[aria-sort=descending] button::after{content:" ▼"}
#map output{display:grid;gap:2px;font-size:.9rem;margin-top:8px;min-height:6.6em;align-content:start;font-variant-numeric:tabular-nums}#map output[hidden]{display:none}
.notes li{margin-bottom:6px}
.words dt{font-weight:600;margin-top:10px}.words dd{margin:2px 0 0;max-width:78ch;color:var(--dim)}
footer{color:var(--dim);font-size:.88rem;padding-top:30px;padding-bottom:40px}
@media(max-width:560px){figure,.card{padding:10px 8px}svg{font-size:15.5px}.card h2,.card p,.card .big,figcaption{padding:0 6px}}
@media(prefers-color-scheme:dark){
:root{--paper:#0d1117;--sheet:#151b23;--ink:#e6edf3;--dim:#9aa4af;--rule:#30363d;--good:#3fb950;--bad:#ff7b72;--warn:#d29922;--accent:#58a6ff;--good-bg:#12261a;--bad-bg:#2d1618;--warn-bg:#2b2413}
svg .ink{fill:#e6edf3}svg .dim{fill:#9aa4af}svg .line{stroke:#e6edf3}svg .grid{stroke:#363d47}svg .support{stroke:#aab4bf}
svg .load{fill:#f0a45d;stroke:#f0a45d}svg .contact{stroke:#ff7b72}svg .bad{fill:#ff7b72}svg .band{fill:#58a6ff;fill-opacity:.3}
svg .b0{fill:#234566}svg .b1{fill:#57461f}svg .b2{fill:#24503a}svg .b3{fill:#4d3a55}svg .b4{fill:#5c362f}svg .b5{fill:#3b4250}
svg .s0{stroke:#58a6ff}svg .s1{stroke:#ff9457}svg .s2{stroke:#3ccf9b}svg .s3{stroke:#d990c4}svg .s4{stroke:#d9b23c}svg .s5{stroke:#aab4bf}
svg text[paint-order]{stroke:#151b23}svg .mesh{stroke:#8b98a5}svg .m{stroke:none}svg .m.s0{fill:#58a6ff}svg .m.s1{fill:#ff9457}svg .m.s2{fill:#3ccf9b}svg .m.s3{fill:#d990c4}svg .m.s4{fill:#d9b23c}svg .m.s5{fill:#aab4bf}
}
@page{size:A4;margin:15mm 14mm}
@media print{
body{font-size:10.5pt}header,main,footer{max-width:none;padding-left:0;padding-right:0}header{padding-top:0}
#pictures,#checks,#energy{break-before:page}h2{margin-top:26px}#pictures h2,#checks h2,#energy h2{margin-top:0}
figure,.card:not(.asked),.asked-for>div,tr,.failures li,.verdict,dl.words div{break-inside:avoid}h2,caption,dt{break-after:avoid}
.first{display:block}.first>*,.answers>*{margin-bottom:12px}.card svg{max-height:92mm}
.gallery{display:block}.gallery figure{margin-bottom:10px}figure svg{max-height:84mm}.stage{max-width:140mm}#map figcaption,figcaption{font-size:9pt}
.scroll{overflow:visible}table{font-size:8pt}td,th{padding:3px 8px 3px 0}thead{display:table-header-group}td.long a,summary::marker{display:none}p{max-width:none}td,th{min-width:0!important;white-space:normal!important}td.long,td.why{min-width:80px!important}
.sortable tr{display:grid;grid-template-columns:minmax(0,42mm) 12mm repeat(5,minmax(0,1fr)) 19mm;padding:2px 0;border-bottom:1px solid var(--rule)}.sortable td,.sortable th{border:0;padding:1px 6px 1px 0}.sortable td.why,.sortable th:last-child{grid-column:1/-1}
figcaption,p,li{orphans:3;widows:3}.tools,.how,.skip,#map output{display:none!important}.back,figcaption details{display:none}
*{print-color-adjust:exact;-webkit-print-color-adjust:exact}
}
"#;
