#include "snapshots/snapshot.h"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/gpu/egl_context.h"
#include "io/error.h"
#include "io/suggest.h"
#include "snapshots/contact_sheet.h"
#include "viewer/captions.h"
#include "viewer/run_session.h"

namespace vantage {
namespace {

constexpr const char* kFolderPattern = "{run}-step{step}-{view}.png";
constexpr const char* kSheetName = "{run}-sheet{view}.png";

bool isPng(const std::string& output) {
  return std::filesystem::path(output).extension() == ".png";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string stepText(int step) {
  char text[16];
  std::snprintf(text, sizeof(text), "%02d", step);
  return text;
}

/// The steps to draw: those asked for, and the closing map if one of the recipes can show it.
std::vector<int> stepsOf(const RunSession& run, const SnapshotRequest& request,
                         const std::vector<Recipe>& recipes) {
  const std::string file = run.path().string();
  const bool shows_map =
      std::any_of(recipes.begin(), recipes.end(), [](const Recipe& recipe) { return !recipe.planning(); });
  std::vector<int> steps;
  for (const StepSummary& summary : run.summaries()) steps.push_back(summary.step);
  const bool closing = !steps.empty() && run.summaries().back().closing;
  if (!request.step) {
    if (closing && !shows_map) steps.pop_back();
    if (steps.empty()) throw InputError(file, "the run has no finished step yet; explore further first");
    return steps;
  }
  const bool end = *request.step == SnapshotRequest::kEnd;
  if (end && !closing)
    throw InputError(file, "there is no map after the last scan: the run was cut off; name a step");
  const int step = end ? steps.back() : *request.step;
  if (std::find(steps.begin(), steps.end(), step) == steps.end()) {
    const std::string known =
        steps.empty() ? "none" : std::to_string(steps.front()) + " .. " + std::to_string(steps.back());
    throw InputError(file, "there is no step " + std::to_string(step) + "; recorded: " + known);
  }
  if (closing && step == steps.back() && !shows_map)
    throw InputError(
        "recipe '" + recipes.front().name + "'",
        "it shows planning, which the map after the last scan does not have; try scene, states or slice");
  return {step};
}

void checkRequest(const SnapshotRequest& request, std::size_t steps, std::size_t wanted) {
  if (request.output.empty()) throw InputError("output", "no file or folder is named; give one");
  constexpr int kSmallest = SnapshotRequest::kSmallestSide;
  if (std::min(request.width, request.height) < kSmallest ||
      std::max(request.width, request.height) > kLargestPicture) {
    throw InputError("size " + std::to_string(request.width) + "x" + std::to_string(request.height),
                     "a side is out of range; allowed: " + std::to_string(kSmallest) + " .. " +
                         std::to_string(kLargestPicture) + " pixels");
  }
  if (!isPng(request.output)) return;
  const std::filesystem::path folder = std::filesystem::path(request.output).parent_path();
  if (!folder.empty() && folder.string().find('{') == std::string::npos &&
      !std::filesystem::is_directory(folder))
    throw InputError(request.output, "there is no folder '" + folder.string() + "'; make it first");
  const auto lacks = [&](const char* part) { return request.output.find(part) == std::string::npos; };
  if (steps > 1 && lacks("{step}"))
    throw InputError(request.output, "several steps would go into one file; add {step} or name a folder");
  if (wanted > 1 && lacks("{view}"))
    throw InputError(request.output, "several recipes would go into one file; add {view} or name a folder");
}

/// A view to trace that no picture would trace.
void requireRays(const SnapshotRequest& request, const std::vector<Recipe>& recipes) {
  const bool asked =
      std::ranges::any_of(request.style, [](const std::string& s) { return s.starts_with("view_id"); });
  if (asked && std::ranges::none_of(recipes, &Recipe::showsRays))
    throw InputError("--style view_id", "recipe '" + recipes.front().name +
                                            "' draws no rays of a view, which it is about; try recipe rays");
}

/// Pictures and sheets of a run, step by step.
class SnapshotSession {
 public:
  SnapshotSession(const std::filesystem::path& run, const SnapshotRequest& request, const RunControl& control)
      : request_(request), control_(control), session_(run) {
    const std::vector<std::string> names =
        request.recipes.empty() ? defaultRecipesOf(*session_.header()) : request.recipes;
    for (const std::string& name : names) {
      if (name == kArmRecipe && !session_.header()->arm)
        throw InputError("recipe '" + name + "'",
                         "the run has no arm; explore with --robot NAME ('vantage robots' lists them)");
      recipes_.push_back(recipeFrom(name));
      for (const std::string& assignment : request.style) setStyle(recipes_.back().view.style, assignment);
    }
    requireRays(request, recipes_);
    steps_ = stepsOf(session_, request, recipes_);
    checkRequest(request, steps_.size(), recipes_.size());
    name_ = run.stem().string();
    context_ = std::make_unique<EglContext>();
    renderer_ = std::make_unique<OffscreenRenderer>(*context_);
  }

  std::vector<std::filesystem::path> take() {
    for (const int step : steps_) {
      control_.check();
      drawStep(step);
    }
    if (written_.empty())
      throw InputError("recipe '" + recipes_.front().name + "'",
                       "no step has anything of it: all were chosen by the " + session_.header()->planner +
                           " planner; try " +
                           joined(defaultRecipes(plannersFromText(session_.header()->planner).front())));
    if (sheet_ && sheet_->rows() > 0) finishSheet();
    return written_;
  }

 private:
  void drawStep(int step) {
    const StepData shown = session_.load(step);
    const SceneFrame frame = shown.frame();
    const bool closing = frame.record.closing;
    const PlannerKind planner = plannerKindOf(frame.header, frame.record);
    if (request_.step) requireOwn(frame.record, planner);
    scene_.setFrame(frame);
    const std::uint64_t total = steps_.size() * recipes_.size();
    for (const Recipe& recipe : recipes_) {
      control_.check();
      control_.report("pictures", done_++, total);
      if (closing && recipe.planning()) continue;
      if (request_.recipes.empty() ? !recipe.fits(planner) : recipe.foreign(planner)) continue;
      const RgbImage image = drawRecipe(scene_, *renderer_, recipe, frame, request_.width, request_.height);
      written_.push_back(snapshotPath(request_.output, name_, step, recipe.name));
      writePng(image, written_.back());
    }
    control_.report("pictures", done_, total);
    if (request_.contact_sheet && !request_.step && !isPng(request_.output)) addToSheet(frame);
  }

  /// One step is asked for, and what is to be shown of it does not exist.
  void requireOwn(const StepRecord& record, PlannerKind planner) const {
    if (request_.recipes.empty()) return;
    for (const Recipe& recipe : recipes_)
      if (recipe.foreign(planner))
        throw InputError("recipe '" + recipe.name + "'",
                         "step " + std::to_string(record.step) + " has nothing of it: it was chosen by the " +
                             std::string(toString(planner)) + " planner; try " +
                             joined(defaultRecipes(planner)));
  }

  void addToSheet(const SceneFrame& frame) {
    if (sheet_ && sheet_->rows() == ContactSheet::kMostRows) finishSheet();
    if (!sheet_)
      sheet_ =
          std::make_unique<ContactSheet>(name_ + "  ·  " + session_.header()->planner + " planner", recipes_);
    sheet_->addRow(scene_, *renderer_, frame);
  }

  void finishSheet() {
    ++sheets_;
    const std::string number = sheets_ > 1 ? "-" + std::to_string(sheets_) : "";
    written_.push_back(
        snapshotPath((std::filesystem::path(request_.output) / kSheetName).string(), name_, 0, number));
    writePng(sheet_->draw(*renderer_), written_.back());
    sheet_.reset();
  }

  SnapshotRequest request_;
  RunControl control_;
  RunSession session_;
  std::string name_;
  std::vector<Recipe> recipes_;
  std::vector<int> steps_;
  std::unique_ptr<EglContext> context_;
  std::unique_ptr<OffscreenRenderer> renderer_;
  Scene scene_;
  std::unique_ptr<ContactSheet> sheet_;
  int sheets_ = 0;
  std::uint64_t done_ = 0;
  std::vector<std::filesystem::path> written_;
};

}  // namespace

std::filesystem::path snapshotPath(const std::string& output, const std::string& run, int step,
                                   const std::string& recipe) {
  const std::string pattern =
      isPng(output) ? output : (std::filesystem::path(output) / kFolderPattern).string();
  std::string path;
  for (std::size_t at = 0; at < pattern.size();) {
    const std::size_t end = pattern[at] == '{' ? pattern.find('}', at) : std::string::npos;
    if (end == std::string::npos) {
      path += pattern[at++];
      continue;
    }
    const std::string name = pattern.substr(at + 1, end - at - 1);
    if (name == "run") {
      path += run;
    } else if (name == "step") {
      path += stepText(step);
    } else if (name == "view") {
      path += recipe;
    } else {
      const std::vector<std::string> known = {"run", "step", "view"};
      throw InputError(output, "unknown placeholder '{" + name + "}'" + suggestion(name, known));
    }
    at = end + 1;
  }
  return path;
}

RgbImage drawRecipe(Scene& scene, OffscreenRenderer& renderer, const Recipe& recipe, const SceneFrame& frame,
                    int width, int height) {
  const std::optional<int>& id = recipe.view.style.view_id;
  const bool other = id && recipe.title == recipeNamed("rays").title;
  scene.show(viewFor(recipe, frame),
             {other ? "Rays of view " + std::to_string(*id) : recipe.title, stepLine(frame),
              recipe.figures(frame, recipe.view.style)},
             PageStyle::Full, width, height);
  return renderer.render(scene.renderers(), width, height);
}

std::vector<std::filesystem::path> takeSnapshots(const std::filesystem::path& run,
                                                 const SnapshotRequest& request, const RunControl& control) {
  return SnapshotSession(run, request, control).take();
}

}  // namespace vantage
