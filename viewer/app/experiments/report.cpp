#include "viewer/app/experiments/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "io/text_file.h"

namespace vantage::experiments {
namespace {

/// Number of characters that a terminal shows for UTF-8 text.
std::size_t shownWidth(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - std::min(width, shownWidth(text)), ' ');
  return right ? blanks + text : text + blanks;
}

std::string csvWord(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

Table claimTable(const Report& report) {
  Table table{"summary", "Summary", {"experiment", "claim", "paper", "ours", "verdict", "remark"}, {}};
  for (const Claim& c : report.claims)
    table.rows.push_back(
        {c.experiment, c.claim, c.paper, c.ours, std::string(toString(c.verdict)), c.remark});
  return table;
}

/// Adds defaults to those that are listed already.
void mergeDefaults(std::vector<DefaultUsed> from, std::vector<DefaultUsed>& to) {
  for (DefaultUsed& other : from) {
    const auto same = std::ranges::find_if(
        to, [&](const DefaultUsed& d) { return d.name == other.name && d.value == other.value; });
    if (same == to.end())
      to.push_back(std::move(other));
    else if (!other.where.empty() && same->where != other.where)
      same->where += (same->where.empty() ? "" : ", ") + other.where;
  }
}

template <class T>
void moveInto(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

}  // namespace

Table defaultTable(const Report& report) {
  Table table{"defaults",
              "Defaults that were used and that the paper does not give",
              {"what", "value", "reason", "used by"},
              {}};
  for (const DefaultUsed& d : report.defaults) table.rows.push_back({d.name, d.value, d.reason, d.where});
  return table;
}

Cell Cell::number(double value, int decimals, std::string_view unit) {
  Cell cell(fmt::format("{:.{}f}{}", value, decimals, unit));
  cell.value = value;
  return cell;
}

Cell Cell::maybe(const std::optional<double>& value, int decimals, std::string_view unit) {
  return value ? number(*value, decimals, unit) : Cell("-");
}

std::string_view toString(Verdict verdict) {
  constexpr std::string_view kNames[] = {"pass", "missed", "not comparable", "not run"};
  return kNames[static_cast<int>(verdict)];
}

void Report::append(Report other) {
  moveInto(other.setup, setup);
  moveInto(other.tables, tables);
  moveInto(other.claims, claims);
  moveInto(other.lines, lines);
  moveInto(other.bars, bars);
  moveInto(other.pictures, pictures);
  mergeDefaults(std::move(other.defaults), defaults);
  moveInto(other.notes, notes);
  moveInto(other.not_run, not_run);
}

void Report::markInterruption() {
  if (not_run.empty()) return;
  for (Claim& claim : claims) {
    if (claim.verdict == Verdict::NotRun) continue;
    if (claim.verdict == Verdict::Pass) claim.verdict = Verdict::NotComparable;
    claim.remark += "; interrupted: of the finished runs alone";
  }
  for (const std::string& part : not_run) {  // the experiment's name comes first
    const std::size_t blank = part.find(' ');
    claims.push_back({part.substr(0, blank), blank == std::string::npos ? "-" : part.substr(blank + 1), "-",
                      "-", Verdict::NotRun, "interrupted"});
  }
}

std::string tableText(const Table& table) {
  std::vector<std::size_t> widths;
  std::vector<bool> numbers;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::size_t width = shownWidth(table.columns[c]);
    bool number = !table.rows.empty();
    for (const auto& row : table.rows) {
      width = std::max(width, shownWidth(row[c].text));
      number = number && (row[c].value || row[c].text == "-");
    }
    widths.push_back(width);
    numbers.push_back(number);
  }
  const auto line = [&](const auto& text_of) {
    std::string text;
    for (std::size_t c = 0; c < widths.size(); ++c)
      text += (c ? " | " : "") + padded(text_of(c), widths[c], numbers[c]);
    return text.erase(text.find_last_not_of(' ') + 1) + "\n";
  };
  std::string text = table.title + "\n" + line([&](std::size_t c) { return table.columns[c]; });
  for (const auto& row : table.rows) text += line([&](std::size_t c) { return row[c].text; });
  return text;
}

std::string summaryText(const Report& report) {
  std::string text = tableText(claimTable(report));
  if (!report.defaults.empty()) text += "\n" + tableText(defaultTable(report));
  if (!report.notes.empty()) text += "\nNotes\n";
  for (const std::string& note : report.notes) text += "- " + note + "\n";
  return text;
}

std::string tableCsv(const Table& table) {
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c) text += (c ? "," : "") + csvWord(table.columns[c]);
  text += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c)
      text += (c ? "," : "") + (row[c].value ? shortestNumber(*row[c].value) : csvWord(row[c].text));
    text += "\n";
  }
  return text;
}

std::string reportJson(const Report& report) {
  nlohmann::ordered_json json;
  json["title"] = report.title;
  json["setup"] = report.setup;
  for (const Claim& c : report.claims)
    json["claims"].push_back({{"experiment", c.experiment},
                              {"claim", c.claim},
                              {"paper", c.paper},
                              {"ours", c.ours},
                              {"verdict", toString(c.verdict)},
                              {"remark", c.remark}});
  for (const Table& table : report.tables) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const auto& row : table.rows) {
      nlohmann::ordered_json entry;
      for (std::size_t c = 0; c < row.size(); ++c)
        if (row[c].value)
          entry[table.columns[c]] = *row[c].value;
        else
          entry[table.columns[c]] = row[c].text;
      rows.push_back(std::move(entry));
    }
    json["tables"][table.name] = {{"title", table.title}, {"rows", std::move(rows)}};
  }
  for (const LinePlot& plot : report.lines)
    for (const LinePlot::Series& series : plot.series)
      json["curves"][plot.title][series.label] = series.values;
  for (const Picture& picture : report.pictures)
    json["pictures"].push_back({{"figure", picture.figure},
                                {"title", picture.title},
                                {"caption", picture.caption},
                                {"file", picture.name + ".png"}});
  for (const DefaultUsed& d : report.defaults)
    json["defaults"].push_back(
        {{"name", d.name}, {"value", d.value}, {"reason", d.reason}, {"used_by", d.where}});
  json["notes"] = report.notes;
  json["not_run"] = report.not_run;
  return json.dump(2) + "\n";
}

std::vector<std::filesystem::path> writeReport(const Report& report, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder))
    throw InputError(folder.string(), "is no folder and cannot be made one; choose another name");
  std::vector<std::filesystem::path> written;
  const auto save = [&](const std::string& name, const std::string& text) {
    written.push_back(folder / name);
    saveFile(written.back(), text);
  };
  for (const Table& table : report.tables) save(table.name + ".csv", tableCsv(table));
  for (const Picture& picture : report.pictures) save(picture.name + ".png", picture.png);
  save("summary.csv", tableCsv(claimTable(report)));
  save("report.json", reportJson(report));
  save("report.html", reportHtml(report));
  return written;
}

}  // namespace vantage::experiments
