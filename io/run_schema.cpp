#include "io/run_schema.h"

#include "io/error.h"

namespace vantage {
namespace {

constexpr const char* kSchema = R"sql(
CREATE TABLE run (key TEXT PRIMARY KEY, value TEXT);
CREATE TABLE run_product (name TEXT PRIMARY KEY, raw_bytes INTEGER NOT NULL, data BLOB NOT NULL);
CREATE TABLE step (
  step INTEGER PRIMARY KEY, status TEXT NOT NULL, planner TEXT,
  x_m REAL, y_m REAL, z_m REAL, qx REAL, qy REAL, qz REAL, qw REAL,
  gain REAL, gain_voxels INTEGER, realised_voxels INTEGER, segment INTEGER, saliency REAL, toward_object INTEGER,
  path_length_m REAL,
  frame INTEGER, served_x_m REAL, served_y_m REAL, served_z_m REAL,
  served_qx REAL, served_qy REAL, served_qz REAL, served_qw REAL,
  poses_generated INTEGER, poses_scored INTEGER, poses_above_threshold INTEGER, poses_unreachable INTEGER,
  poses_executed_before INTEGER, rays INTEGER, voxels_visited INTEGER, paths_planned INTEGER,
  changed_bricks INTEGER, contour_voxels INTEGER, contour_points INTEGER, surface_points INTEGER, segments INTEGER,
  unknown_voxels INTEGER, unknown_near_objects INTEGER, unknown_in_boxes INTEGER, coverage REAL,
  sense_s REAL, filter_s REAL, fuse_s REAL, contours_s REAL, surface_s REAL, segmentation_s REAL, saliency_s REAL,
  generation_s REAL, evaluation_s REAL, collision_map_s REAL, motion_planning_s REAL, motion_s REAL,
  box_unknown INTEGER, box_occupied INTEGER, rejected_position INTEGER, rejected_registration INTEGER,
  finest_rays INTEGER, occupied REAL, distance REAL, utility REAL, literal_stop INTEGER);
CREATE TABLE view (
  step INTEGER, view INTEGER, x_m REAL, y_m REAL, z_m REAL, qx REAL, qy REAL, qz REAL, qw REAL, frame INTEGER,
  reject TEXT, reachability TEXT, unknown REAL, occupied REAL, surface REAL, distance REAL, utility REAL,
  rays INTEGER, visited INTEGER, PRIMARY KEY (step, view));
CREATE TABLE closing (
  step INTEGER PRIMARY KEY,
  unknown_voxels INTEGER, unknown_near_objects INTEGER, unknown_in_boxes INTEGER, coverage REAL,
  box_unknown INTEGER, box_occupied INTEGER);
CREATE TABLE scan (
  step INTEGER, number INTEGER, frame INTEGER,
  x_m REAL, y_m REAL, z_m REAL, qx REAL, qy REAL, qz REAL, qw REAL, PRIMARY KEY (step, number));
CREATE TABLE segment (
  step INTEGER, segment INTEGER, points INTEGER, saliency REAL, isolation REAL, roundness REAL,
  d1_m REAL, d2_m REAL, d3_m REAL, cx_m REAL, cy_m REAL, cz_m REAL, radius_m REAL, PRIMARY KEY (step, segment));
CREATE TABLE product (
  step INTEGER NOT NULL, stage TEXT NOT NULL, name TEXT NOT NULL, raw_bytes INTEGER NOT NULL, data BLOB NOT NULL,
  PRIMARY KEY (step, stage, name));
CREATE VIEW chosen AS
  SELECT step, x_m, y_m, z_m, qx, qy, qz, qw, gain, gain_voxels, realised_voxels, segment, saliency, path_length_m
  FROM step WHERE status = 'view';
)sql";

void bindPosition(Statement& s, const Pose& pose) {
  for (int i = 0; i < 3; ++i) s.bind(pose.translation()[i]);
  const Eigen::Quaterniond q = orientationOf(pose);
  s.bind(q.x()).bind(q.y()).bind(q.z()).bind(q.w());
}

void bindNulls(Statement& s, int count) {
  for (int i = 0; i < count; ++i) s.bindNull();
}

void bindChosen(Statement& s, const StepRecord& r) {
  if (!r.hasView()) return bindNulls(s, 14);
  const ChosenView& chosen = *r.chosen();
  bindPosition(s, chosen.T_world_camera);
  s.bind(chosen.gain).bind(chosen.gain_voxels).bind(r.realised_voxels);
  const SegmentSearch* from = r.search && r.search->chosen->search < r.search->segments.size()
                                  ? &r.search->segments[r.search->chosen->search]
                                  : nullptr;
  if (from && from->segment >= 0 && r.saliency &&
      from->segment < static_cast<int>(r.saliency->segments.size())) {
    s.bind(r.saliency->segments[from->segment].label);
  } else {
    s.bindNull();
  }
  from ? s.bind(from->saliency) : s.bindNull();
  s.bind(r.toward_object).bind(chosen.path.length_m);
}

void bindServed(Statement& s, const std::optional<ScanPose>& served) {
  if (!served) return bindNulls(s, 8);
  s.bind(served->frame);
  bindPosition(s, served->T_world_camera);
}

void bindCounts(Statement& s, const StepRecord& r) {
  if (r.counts()) {
    const SearchCounts& c = *r.counts();
    s.bind(c.poses_generated).bind(c.poses_scored).bind(c.poses_above_threshold).bind(c.poses_unreachable);
    s.bind(c.poses_executed_before).bind(c.rays).bind(c.voxels_visited).bind(c.paths_planned);
  } else {
    bindNulls(s, 8);
  }
  const auto size = [&](bool present, auto count) {
    present ? s.bind(std::uint64_t{count()}) : s.bindNull();
  };
  size(r.changed_bricks != nullptr, [&] { return r.changed_bricks->size(); });
  size(r.contours != nullptr, [&] { return r.contours->voxels.size(); });
  size(r.contours != nullptr, [&] { return r.contours->points.size(); });
  size(r.surface != nullptr, [&] { return r.surface->points.size(); });
  size(r.labels != nullptr, [&] { return r.labels->count; });
}

void bindMetrics(Statement& s, const MapMetrics& m) {
  s.bind(m.unknown_voxels).bind(m.unknown_near_objects).bind(m.unknown_in_boxes).bind(m.coverage);
}

void bindTimings(Statement& s, const Timings& t) {
  s.bind(t.sense).bind(t.filter).bind(t.fuse).bind(t.contours).bind(t.surface).bind(t.segmentation);
  s.bind(t.saliency).bind(t.generation).bind(t.evaluation).bind(t.collision_map).bind(t.motion_planning);
  s.bind(t.motion);
}

void bindBox(Statement& s, const StepRecord& r) {
  if (!r.box) return bindNulls(s, 2);
  s.bind(r.box->unknown).bind(r.box->occupied);
}

/// What the hierarchical planner adds.
void bindUtilities(Statement& s, const StepRecord& r) {
  if (!r.utilities) return bindNulls(s, 7);
  const UtilitySearch& u = *r.utilities;
  s.bind(u.rejected_position).bind(u.rejected_registration).bind(u.finest_rays_cast);
  if (const ViewUtility* view = chosenUtility(u)) {
    s.bind(view->occupied).bind(view->distance).bind(view->utility);
  } else {
    bindNulls(s, 3);
  }
  s.bind(int{u.literal_stop});
}

/// "?,?,...": one mark for each of `count` columns.
std::string marks(int count) {
  std::string text = "?";
  for (int i = 1; i < count; ++i) text += ",?";
  return text;
}

void insertScan(Database& database, const std::vector<ScanPose>& scan, int step) {
  Statement s(database, "INSERT INTO scan VALUES (" + marks(10) + ")");
  for (std::size_t i = 0; i < scan.size(); ++i) {
    s.bind(step).bind(std::uint64_t{i}).bind(scan[i].frame);
    bindPosition(s, scan[i].T_world_camera);
    s.finish();
  }
}

void insertSegments(Database& database, const Saliency& saliency, int step) {
  Statement s(database, "INSERT OR REPLACE INTO segment VALUES (" + marks(13) + ")");
  for (const Segment& g : saliency.segments) {
    s.bind(step).bind(g.label).bind(g.points).bind(g.saliency).bind(g.isolation).bind(g.roundness);
    for (const Eigen::Vector3d& v : {g.extent_m, g.center_m})
      for (int i = 0; i < 3; ++i) s.bind(v[i]);
    s.bind(g.radius_m).finish();
  }
}

void insertViews(Database& database, const UtilitySearch& search, int step) {
  Statement s(database, "INSERT OR REPLACE INTO view VALUES (" + marks(19) + ")");
  for (const ViewUtility& v : search.views) {
    s.bind(step).bind(v.id);
    bindPosition(s, v.T_world_camera);
    s.bind(v.frame).bind(std::string(tokenOf(v.rejection))).bind(std::string(tokenOf(v.reachability)));
    s.bind(v.unknown).bind(v.occupied).bind(v.surface).bind(v.distance).bind(v.utility);
    s.bind(v.rays.rays_cast).bind(v.rays.visited).finish();
  }
}

}  // namespace

void createSchema(Database& database) {
  database.run("PRAGMA application_id=" + std::to_string(kRunApplicationId));
  database.run("PRAGMA user_version=" + std::to_string(kRunVersion));
  database.run(kSchema);
}

void requireRun(Database& database) {
  const std::int64_t id = database.number("PRAGMA application_id");
  if (id != kRunApplicationId)
    throw InputError(database.name(),
                     "is an SQLite file but not a run file; give a .vantage file that `vantage "
                     "explore -o` wrote");
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version > kRunVersion)
    throw InputError(database.name(), "has version " + std::to_string(version) +
                                          " of the run file; this program reads " + "versions up to " +
                                          std::to_string(kRunVersion) + "; open it with a newer vantage");
  if (version < 1)
    throw InputError(database.name(),
                     "is damaged (version " + std::to_string(version) + "); record the run again");
}

void putRunValue(Database& database, const std::string& key, const std::string& value) {
  Statement(database, "INSERT OR REPLACE INTO run VALUES (?,?)").bind(key).bind(value).finish();
}

void putProduct(Database& database, const StoredProduct& product, int step) {
  Statement s(database, "INSERT OR REPLACE INTO product VALUES (?,?,?,?,?)");
  s.bind(step)
      .bind(product.stage)
      .bind(product.name)
      .bind(product.raw_bytes)
      .bind(std::span(product.data))
      .finish();
}

void putRunProduct(Database& database, const StoredProduct& product) {
  Statement s(database, "INSERT OR REPLACE INTO run_product VALUES (?,?,?)");
  s.bind(product.name).bind(product.raw_bytes).bind(std::span(product.data)).finish();
}

void insertHeader(Database& database, const RunHeader& h) {
  const auto put = [&](const char* key, const std::string& value) { putRunValue(database, key, value); };
  put("input", h.input);
  put("planner", h.planner);
  put("robot", h.robot);
  put("command_line", h.command_line);
  put("version", h.version);
  put("scene_toml", h.scene_toml);
  put("config_toml", h.config_toml);
  put("seed", std::to_string(h.seed));
  put("threads", std::to_string(h.threads));
  put("compute", h.compute);
  put("replay", h.replay ? "1" : "0");
  put("voxel_size_m", std::to_string(h.volume.voxel_size_m));
  const Eigen::Vector3i& size = h.volume.size;
  put("volume_voxels",
      std::to_string(size.x()) + "x" + std::to_string(size.y()) + "x" + std::to_string(size.z()));
}

void insertStep(Database& database, const StepRecord& r, int step) {
  Statement s(database, "INSERT INTO step VALUES (" + marks(63) + ")");
  s.bind(step).bind(r.hasView() ? "view" : "none").bind(r.planner);
  bindChosen(s, r);
  bindServed(s, r.served);
  bindCounts(s, r);
  bindMetrics(s, r.metrics);
  bindTimings(s, r.timings);
  bindBox(s, r);
  bindUtilities(s, r);
  s.finish();
  insertScan(database, r.scan, step);
  if (r.saliency) insertSegments(database, *r.saliency, step);
  if (r.utilities) insertViews(database, *r.utilities, step);
}

void updateRealised(Database& database, const Realised& realised, int step) {
  Statement s(
      database,
      "UPDATE step SET realised_voxels=?, frame=?, served_x_m=?, served_y_m=?, served_z_m=?, served_qx=?, "
      "served_qy=?, served_qz=?, served_qw=? WHERE step=?");
  s.bind(realised.voxels);
  bindServed(s, realised.served);
  s.bind(step).finish();
}

void insertClosing(Database& database, const StepRecord& r, int step) {
  Statement s(database, "INSERT INTO closing VALUES (?,?,?,?,?,?,?)");
  s.bind(step);
  bindMetrics(s, r.metrics);
  bindBox(s, r);
  s.finish();
  insertScan(database, r.scan, step);
}

}  // namespace vantage
