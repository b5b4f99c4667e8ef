#include "io/report_style.hpp"

namespace thermovox {

const char* const kReportStyle = R"css(
@page { size: A4; margin: 15mm 14mm 16mm 14mm; @bottom-right { content: counter(page) " / " counter(pages);
  font: 8pt sans-serif; color: #555; } }
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { font: 10pt/1.42 "Liberation Sans", Arial, Helvetica, sans-serif; color: #16191d; background: #fff;
  margin: 0 auto; max-width: 190mm; padding: 8mm 5mm; -webkit-print-color-adjust: exact;
  print-color-adjust: exact; }
h1 { font-size: 22pt; line-height: 1.15; margin: 0 0 1mm; overflow-wrap: anywhere; }
h2 { font-size: 15pt; margin: 9mm 0 2.5mm; padding-bottom: 1mm; border-bottom: 0.5mm solid #16191d; }
h3 { font-size: 11pt; margin: 5mm 0 1.5mm; }
h1, h2, h3 { break-after: avoid; }
p { margin: 0 0 2mm; }
a { color: #0b4f94; text-decoration: none; }
.lead { color: #4a5058; margin-bottom: 5mm; }
.verdict { border-left: 1.6mm solid #0b4f94; background: #f1f5f9; padding: 3mm 4mm; margin: 0 0 5mm;
  font-size: 11pt; break-inside: avoid; }
.verdict.alarm { border-color: #a3120a; background: #fdf1ef; }
.verdict p:last-child { margin: 0; }
.note { color: #4a5058; font-size: 8.5pt; }
nav { font-size: 9pt; margin: 0 0 4mm; }
nav a { margin-right: 4mm; white-space: nowrap; }
.scroll { overflow-x: auto; margin: 0 0 3mm; }
table { border-collapse: collapse; width: 100%; font-size: 8.6pt; line-height: 1.3; }
thead { display: table-header-group; }
tr, figure, svg, .block, .whole { break-inside: avoid; }
th, td { text-align: left; vertical-align: top; padding: 1mm 1.6mm; border-bottom: 0.2mm solid #cdd2d8; }
th { font-weight: bold; border-bottom: 0.4mm solid #16191d; vertical-align: bottom; }
td.r, th.r { text-align: right; font-variant-numeric: tabular-nums; }
td.r { white-space: nowrap; }
.date { white-space: nowrap; }
td.l { overflow-wrap: break-word; }
table.facts { width: 100%; }
table.facts th { width: 44%; font-weight: normal; color: #4a5058; border-bottom: 0.2mm solid #cdd2d8;
  vertical-align: top; }
figure { margin: 0 0 4mm; }
figure svg, figure img { display: block; width: 100%; height: auto; }
figcaption { font-size: 8.5pt; color: #4a5058; margin-top: 1mm; }
.spot, .sheet { break-before: page; }
.spot h2 { margin-top: 0; display: flex; flex-wrap: wrap; gap: 1mm 3mm; align-items: baseline; }
@media screen { .spot { border-top: 0.2mm solid #cdd2d8; margin-top: 12mm; padding-top: 8mm; } }
.columns { display: grid; grid-template-columns: 1fr 1fr; gap: 0 6mm; align-items: start; }
.pictures { display: grid; grid-template-columns: repeat(3, 1fr); gap: 0 5mm; align-items: start; }
.pictures figure { margin-bottom: 1mm; }
.capture { display: grid; grid-template-columns: 1fr 1fr; gap: 0 6mm; align-items: start; }
.capture > * { min-width: 0; }
.beside:nth-child(odd) { grid-column: 1 / -1; margin-bottom: 4mm; }
@media print { .capture { grid-template-columns: repeat(3, 1fr); gap: 0 5mm; } .beside { columns: 2; grid-column: 1 / -1; } }
@media print { .spot h3 { margin-top: 2.5mm; } .pictures svg { width: 48mm; }
  .spot td, .spot th { padding: 0.6mm 1.6mm; } }
.spot h3 { margin-top: 3mm; }
.columns > * { min-width: 0; }
.columns h3:first-child { margin-top: 0; }
.chip { display: inline-block; border-radius: 1mm; padding: 0.2mm 1.6mm; font-size: 8.4pt; font-weight: bold;
  white-space: nowrap; border: 0.25mm solid transparent; }
.s0 { background: #eef0f2; border-color: #9aa3ad; }
.s1 { background: #fff3c4; border-color: #c9a400; }
.s2 { background: #ffd9a8; border-color: #d07a00; }
.s3 { background: #f6b3a6; border-color: #b32d14; }
.s4 { background: #a3120a; border-color: #7d0c06; color: #fff; }
.back { font-size: 9pt; font-weight: normal; margin-left: auto; }
dl { margin: 0; font-size: 9pt; }
dt { font-weight: bold; margin-top: 2mm; break-after: avoid; }
dd { margin: 0; break-inside: avoid; }
ul { margin: 0 0 3mm; padding-left: 5mm; }
@media screen and (max-width: 700px) {
  body { padding: 4mm; font-size: 11pt; }
  .columns, .pictures, .capture { display: block; }
  table { font-size: 9.4pt; }
  .scroll table { min-width: 100%; width: max-content; }
  .scroll td.l { max-width: 60mm; }
}
@media print {
  body { padding: 0; max-width: none; }
  nav, .back { display: none; }
  .scroll { overflow: visible; }
  a { color: inherit; }
}
)css";

}  // namespace thermovox
