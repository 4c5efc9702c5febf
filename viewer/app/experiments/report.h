#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::experiments {

/// One entry of a table: what people read and, for numbers, the value that machines read.
struct Cell {
  std::string text;
  std::optional<double> value;

  Cell(std::string text_) : text(std::move(text_)) {}  // NOLINT: tables are written as lists of words
  Cell(const char* text_) : text(text_) {}             // NOLINT
  /// A number with a fixed number of decimals and a unit that follows it ("%", " ms").
  static Cell number(double value, int decimals = 0, std::string_view unit = "");
  /// A number, or "-" where there is none.
  static Cell maybe(const std::optional<double>& value, int decimals = 0, std::string_view unit = "");
};

struct Table {
  std::string name;   ///< file name without ending, e.g. "a1"
  std::string title;  ///< one line
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< as long as the columns
};

enum class Verdict { Pass, Missed, NotComparable, NotRun };
/// `pass`, `missed`, `not comparable`, `not run`.
std::string_view toString(Verdict verdict);
inline Verdict passIf(bool met) {
  return met ? Verdict::Pass : Verdict::Missed;
}

/// One line of the final summary (evaluation.md, section 7).
struct Claim {
  std::string experiment;  ///< "A1 (1)"
  std::string claim;
  std::string paper;
  std::string ours;
  Verdict verdict = Verdict::NotRun;
  std::string remark;
};

/// Curves over the scans of runs.
struct LinePlot {
  struct Series {
    std::string label;
    std::vector<double> values;  ///< at x = 1, 2, ...
  };
  std::string title, x_label, y_label;
  std::vector<Series> series;
};

/// Labelled bars from zero.
struct BarPlot {
  struct Bar {
    std::string label;
    double value = 0.0;
  };
  std::string title, unit;
  std::vector<Bar> bars;
  std::optional<double> limit;  ///< drawn as a line
};

/// A picture of a scene beside others of its figure.
struct Picture {
  std::string name;     ///< file name without ending, e.g. "b2_saliency"
  std::string figure;   ///< what it is a part of; neighbours with the same one are shown side by side
  std::string title;    ///< a few words: what differs from its neighbours
  std::string caption;  ///< a sentence or two; with the title it stands for the picture to who cannot see it
  std::string png;      ///< bytes of a PNG file
};

/// A value that the paper does not give and that was used.
struct DefaultUsed {
  std::string name, value, reason;
  std::string where;  ///< experiments that used it, e.g. "A1, A3 room"
};

/// Everything that a reproduction prints and writes.
struct Report {
  std::string title;
  std::vector<std::string> setup;  ///< machine, threads, version, command: a line each
  std::vector<Table> tables;
  std::vector<Claim> claims;
  std::vector<LinePlot> lines;
  std::vector<BarPlot> bars;
  std::vector<Picture> pictures;
  std::vector<DefaultUsed> defaults;
  std::vector<std::string> notes;
  std::vector<std::string> not_run;  ///< what an interruption left out, e.g. "A1 compact 0.35 m"

  /// Takes over everything of another report but its title. A default that both have with the same value is
  /// listed once, for both.
  void append(Report other);

  /// Where something was not run: a claim for each part that says so, and no claim stays passed that was
  /// judged on the finished part alone.
  void markInterruption();
};

/// The defaults of a report as a table.
Table defaultTable(const Report& report);
/// A table as aligned columns with ` | ` between them, title first.
std::string tableText(const Table& table);
/// Final summary, defaults and notes as text.
std::string summaryText(const Report& report);
/// One self-contained page, its pictures included.
std::string reportHtml(const Report& report);
std::string reportJson(const Report& report);
/// A table as CSV; numbers in full, without units.
std::string tableCsv(const Table& table);

/// Plots as SVG elements.
std::string plotSvg(const LinePlot& plot);
std::string plotSvg(const BarPlot& plot);

/// The pictures as figures in rows.
std::string picturesHtml(const std::vector<Picture>& pictures);

/// Text for HTML and SVG.
std::string escaped(std::string_view text);

/// Writes NAME.csv of every table, NAME.png of every picture, report.json and report.html into a folder,
/// which is made if need be. Returns the paths. \throws InputError, std::runtime_error as saveFile()
std::vector<std::filesystem::path> writeReport(const Report& report, const std::filesystem::path& folder);

}  // namespace vantage::experiments
