#include "snapshots/comparison.h"

#include <algorithm>
#include <array>
#include <memory>
#include <set>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "snapshots/contact_sheet.h"
#include "snapshots/snapshot.h"
#include "viewer/run_session.h"

namespace vantage {
namespace {

/// Number under which the map after the last scan stands in the list of rows: after all steps of both runs.
constexpr int kEndRow = 1 << 30;

/// One of the two runs while the sheet is drawn.
class ComparedRun {
 public:
  explicit ComparedRun(const std::filesystem::path& path) : session_(path) {}

  const RunHeader& header() const { return *session_.header(); }
  std::string name() const { return path().stem().string(); }
  const std::filesystem::path& path() const { return session_.path(); }

  std::vector<int> rows() const {
    std::vector<int> rows;
    for (const StepSummary& step : session_.summaries()) rows.push_back(step.closing ? kEndRow : step.step);
    return rows;
  }
  bool has(int row) const {
    const std::vector<int> all = rows();
    return std::ranges::find(all, row) != all.end();
  }
  /// The frame of a row that the run has; valid until the next call.
  SceneFrame frame(int row) {
    shown_ = {};  // first: its map serves the next row
    shown_ = session_.load(row == kEndRow ? session_.summaries().back().step : row);
    return shown_.frame();
  }

 private:
  RunSession session_;
  StepData shown_;
};

using Pair = std::array<std::unique_ptr<ComparedRun>, 2>;

/// One place, however its path is spelt; names of embedded scenes stay apart too.
std::filesystem::path placeOf(std::string input) {
  if (input.ends_with('/')) input.pop_back();
  std::error_code error;
  const auto place = std::filesystem::weakly_canonical(std::filesystem::absolute(input, error), error);
  return error ? std::filesystem::path(input) : place;
}

bool sameScene(const RunHeader& a, const RunHeader& b) {
  return placeOf(a.input) == placeOf(b.input) && a.truth.vertices == b.truth.vertices &&
         a.truth.triangles == b.truth.triangles;
}

/// "run 1 1, run 2 7" of values that are not all the same, else empty.
std::string listed(const std::vector<std::string>& values) {
  if (std::ranges::all_of(values, [&](const std::string& value) { return value == values[0]; })) return "";
  std::string text;
  for (std::size_t n = 0; n < values.size(); ++n)
    text += (n > 0 ? ", run " : "run ") + std::to_string(n + 1) + ": " + values[n];
  return text;
}

std::vector<int> rowsOf(const Pair& runs, const ComparisonRequest& request) {
  std::set<int> rows;
  for (const auto& run : runs) {
    for (const int row : run->rows()) rows.insert(row);
  }
  if (!request.step) return {rows.begin(), rows.end()};
  const int wanted = *request.step == SnapshotRequest::kEnd ? kEndRow : *request.step;
  if (!rows.contains(wanted))
    throw InputError("step " + (wanted == kEndRow ? std::string("end") : std::to_string(wanted)),
                     "neither of the runs has it");
  return {wanted};
}

/// Which run a column is of; where they are measured differently, also how.
std::string noteOf(const ComparedRun& run, bool measured_differently) {
  const RunHeader& header = run.header();
  std::string note = run.name() + "  ·  " + header.planner;
  if (!measured_differently) return note;
  const MeasuredMap map = measuredMap(header);
  return note + "  ·  " + map.kind + ", " + lengthText(map.voxel_size_m) + ", seed " +
         std::to_string(header.seed);
}

/// Per recipe a column of each run, under the recipe's title and the run's planner.
std::vector<ContactSheet::Column> columnsOf(const Pair& runs, const ComparisonRequest& request) {
  const std::vector<std::string> names =
      request.recipes.empty() ? std::vector<std::string>{"states", "views"} : request.recipes;
  const bool differently = !differencesOf({runs[0]->header(), runs[1]->header()}).empty();
  std::vector<ContactSheet::Column> columns;
  for (const std::string& name : names) {
    Recipe recipe = recipeFrom(name);
    for (const std::string& assignment : request.style) setStyle(recipe.view.style, assignment);
    for (const auto& run : runs) columns.push_back({recipe.title, recipe, noteOf(*run, differently)});
  }
  return columns;
}

std::filesystem::path pagePath(const std::filesystem::path& output, const Pair& runs, std::size_t page) {
  std::filesystem::path path = output;
  if (path.extension() != ".png") path /= runs[0]->name() + "-" + runs[1]->name() + ".png";
  if (page > 1) path.replace_filename(path.stem().string() + "-" + std::to_string(page) + ".png");
  return path;
}

}  // namespace

MeasuredMap measuredMap(const RunHeader& header) {
  const bool octree_alone = std::ranges::all_of(plannersFromText(header.planner), usesOctree);
  if (octree_alone && header.octree) return {"octree", header.octree->map.voxel_size_m};
  return {"TSDF", header.volume.voxel_size_m};
}

void requireOneScene(const std::vector<std::string>& paths, const std::vector<RunHeader>& headers) {
  for (std::size_t n = 1; n < headers.size(); ++n)
    if (!sameScene(headers[0], headers[n]))
      throw InputError(paths[n], "is about '" + headers[n].input + "', but " + paths[0] + " about '" +
                                     headers[0].input + "'; compare runs of one scene");
}

std::vector<std::string> differencesOf(const std::vector<RunHeader>& headers) {
  std::vector<std::string> maps, voxels, seeds, differences;
  for (const RunHeader& header : headers) {
    const MeasuredMap map = measuredMap(header);
    maps.push_back(map.kind);
    voxels.push_back(lengthText(map.voxel_size_m));
    seeds.push_back(std::to_string(header.seed));
  }
  for (const auto& [what, values] :
       {std::pair("measured on different maps", &maps), std::pair("voxel sizes differ", &voxels),
        std::pair("seeds differ", &seeds)})
    if (const std::string list = listed(*values); !list.empty())
      differences.push_back(std::string(what) + " (" + list + ")");
  return differences;
}

std::vector<std::filesystem::path> takeComparison(const std::filesystem::path& run_a,
                                                  const std::filesystem::path& run_b,
                                                  const ComparisonRequest& request,
                                                  const RunControl& control) {
  if (request.output.empty()) throw InputError("output", "no file or folder is named; give one");
  Pair runs = {std::make_unique<ComparedRun>(run_a), std::make_unique<ComparedRun>(run_b)};
  const std::vector<RunHeader> headers = {runs[0]->header(), runs[1]->header()};
  requireOneScene({run_a.string(), run_b.string()}, headers);
  const std::vector<int> rows = rowsOf(runs, request);
  const std::vector<ContactSheet::Column> columns = columnsOf(runs, request);
  if (rows.empty())
    throw InputError(run_a.string(), "the runs have no finished step yet; explore further first");
  EglContext context;
  OffscreenRenderer renderer(context);
  Scene scene;
  const std::string title = std::filesystem::path(runs[0]->header().input).stem().string() + "  ·  " +
                            runs[0]->name() + " and " + runs[1]->name() + " side by side";
  std::vector<std::filesystem::path> written;
  for (std::size_t first = 0; first < rows.size(); first += ContactSheet::kMostRows) {
    const std::size_t end = std::min(rows.size(), first + ContactSheet::kMostRows);
    ContactSheet sheet(title, columns);
    for (std::size_t r = first; r < end; ++r) {
      sheet.beginRow(rows[r] == kEndRow ? "end" : std::to_string(rows[r]));
      for (std::size_t n = 0; n < runs.size(); ++n) {
        control.check();
        control.report("pictures", r * runs.size() + n, rows.size() * runs.size());
        if (!runs[n]->has(rows[r])) continue;
        const SceneFrame frame = runs[n]->frame(rows[r]);
        scene.setFrame(frame);
        for (std::size_t c = n; c < columns.size(); c += runs.size())
          sheet.setTile(c, scene, renderer, frame);
      }
    }
    written.push_back(pagePath(request.output, runs, written.size() + 1));
    writePng(sheet.draw(renderer), written.back());
  }
  return written;
}

}  // namespace vantage
