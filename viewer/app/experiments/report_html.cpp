#include <fmt/format.h>

#include "viewer/app/experiments/report.h"

namespace vantage::experiments {
namespace {

constexpr std::string_view kStyle = R"(
:root{color-scheme:light dark}
body{font:15px/1.45 system-ui,sans-serif;max-width:76rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fff}
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}
table{border-collapse:collapse;font-size:.85rem;display:block;overflow-x:auto}
th,td{padding:.25rem .6rem;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}
th{border-bottom:2px solid #888}td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.pass{color:#00644c;font-weight:600}.missed{color:#a33c00;font-weight:600}
svg{max-width:100%;height:auto;background:#fff}
.row{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(100%,30rem),1fr));gap:1rem}
figure{margin:0}figure img{width:100%;height:auto;border:1px solid #ddd;cursor:zoom-in}figcaption{font-size:.85rem}
figure img:focus{position:fixed;inset:0;margin:auto;width:auto;max-width:100%;max-height:100%;z-index:1;cursor:zoom-out}
@media(prefers-color-scheme:dark){body{color:#ddd;background:#161616}th,td{border-color:#444}
.pass{color:#3fd0a4}.missed{color:#ff9a5c}}
)";

std::string verdictCell(Verdict verdict) {
  const std::string_view word = toString(verdict);
  const bool coloured = verdict == Verdict::Pass || verdict == Verdict::Missed;
  return fmt::format("<td{}>{}</td>", coloured ? fmt::format(" class=\"{}\"", word) : "", word);
}

std::string header(const std::vector<std::string>& columns) {
  std::string html = "<table><thead><tr>";
  for (const std::string& column : columns) html += "<th>" + escaped(column) + "</th>";
  return html + "</tr></thead><tbody>\n";
}

std::string tableHtml(const Table& table) {
  std::string html = "<h2>" + escaped(table.title) + "</h2>\n" + header(table.columns);
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (const Cell& cell : row)
      html += fmt::format("<td{}>{}</td>", cell.value ? " class=\"n\"" : "", escaped(cell.text));
    html += "</tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string claimsHtml(const Report& report) {
  std::string html =
      "<h2>Summary</h2>\n" + header({"experiment", "claim", "paper", "ours", "verdict", "remark"});
  for (const Claim& c : report.claims) {
    html += "<tr>";
    for (const std::string* text : {&c.experiment, &c.claim, &c.paper, &c.ours})
      html += "<td>" + escaped(*text) + "</td>";
    html += verdictCell(c.verdict) + "<td>" + escaped(c.remark) + "</td></tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string listHtml(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = "<h2>" + title + "</h2>\n<ul>\n";
  for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string reportHtml(const Report& report) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width,initial-scale=1\"><title>{0}</title><style>{1}</style></head>\n"
      "<body><h1>{0}</h1>\n",
      escaped(report.title), kStyle);
  html += listHtml("Set-up", report.setup);
  html += claimsHtml(report);
  for (const BarPlot& plot : report.bars) html += plotSvg(plot);
  for (const LinePlot& plot : report.lines) html += plotSvg(plot);
  html += picturesHtml(report.pictures);
  for (const Table& table : report.tables) html += tableHtml(table);
  if (!report.defaults.empty()) html += tableHtml(defaultTable(report));
  return html + listHtml("Notes", report.notes) + "</body></html>\n";
}

}  // namespace vantage::experiments
