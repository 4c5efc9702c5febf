#include "viewer/pick_text.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/support/synthetic_record.h"

namespace vantage {
namespace {

using ::testing::HasSubstr;

StepData dataOf(const test::SyntheticRun& run) {
  StepData data;
  data.header = std::make_shared<RunHeader>(run.header);
  data.record = std::make_shared<StepRecord>(run.record);
  data.states = std::make_shared<StateGrid>(run.states);
  data.volume = std::make_shared<TsdfVolume>(run.volume);
  return data;
}

std::string textOfPicked(const StepData& data, PickedKind kind, std::uint32_t id,
                         const Eigen::Vector3i& voxel = Eigen::Vector3i::Zero()) {
  Picked picked;
  picked.kind = kind;
  picked.id = id;
  picked.voxel = voxel;
  picked.state = data.states->at(voxel);
  return textOf(picked, data, candidateRows(data.frame()));
}

TEST(PickText, OfASegmentSaysItsPlaceInTheOrderAndItsFactors) {
  const StepData data = dataOf(test::makeSyntheticRun());
  const auto& order = data.record->search->segments;
  const auto second = std::ranges::find_if(order.begin() + 1, order.end(),
                                           [](const SegmentSearch& s) { return s.segment >= 0; });
  ASSERT_NE(second, order.end());
  const Segment& segment = data.record->saliency->segments[second->segment];
  const std::string text = textOfPicked(data, PickedKind::Segment, segment.label);
  ASSERT_EQ(second - order.begin(), 1);
  EXPECT_THAT(text, HasSubstr("segment with label " + std::to_string(segment.label) + ", no. 2 of " +
                              std::to_string(order.size()) + " in the order of trying, "));
  for (const char* word : {"saliency ", "F ", "d_min ", "d_max "}) EXPECT_THAT(text, HasSubstr(word));
}

TEST(PickText, OfASegmentWithoutContourPointsSaysThatItIsNotTried) {
  StepData data = dataOf(test::makeSyntheticRun());
  auto record = std::make_shared<StepRecord>(*data.record);
  auto search = std::make_shared<ViewSearch>(*record->search);
  std::erase_if(search->segments, [](const SegmentSearch& s) { return s.segment == 0; });
  record->search = search;
  data.record = record;
  EXPECT_THAT(textOfPicked(data, PickedKind::Segment, 1), HasSubstr("segment with label 1, not tried"));
}

TEST(PickText, OfAFrustumSaysRankAndScore) {
  const StepData data = dataOf(test::makeSyntheticRun());
  const std::vector<CandidateRow> rows = candidateRows(data.frame());
  const auto chosen = std::ranges::find_if(rows, &CandidateRow::chosen);
  ASSERT_NE(chosen, rows.end());
  const std::string text = textOfPicked(data, PickedKind::Frustum, chosen->id);
  EXPECT_THAT(text, HasSubstr("view " + std::to_string(chosen->id) + ", rank " +
                              std::to_string(*chosen->rank) + ": chosen"));
  EXPECT_THAT(text, HasSubstr("gain "));
  EXPECT_THAT(text, HasSubstr("tried 1st"));
  EXPECT_THAT(textOfPicked(data, PickedKind::Frustum, 4000000000u), HasSubstr("not scored"));
}

TEST(PickText, OfAViewThatFailedATestGivesOnlyWhatWasComputed) {
  const test::SyntheticOctreeRun run = test::makeSyntheticOctreeRun(CandidateGenerator::Workspace);
  StepData data;
  data.header = std::make_shared<RunHeader>(run.header);
  data.record = std::make_shared<StepRecord>(run.record);
  const std::vector<CandidateRow> rows = candidateRows(run.frame());
  const auto text = [&](ViewVerdict verdict) {
    const auto row = std::ranges::find(rows, verdict, &CandidateRow::verdict);
    return row == rows.end() ? "no such view"
                             : textOf({.kind = PickedKind::Frustum, .id = row->id}, data, rows);
  };
  EXPECT_THAT(text(ViewVerdict::Chosen), HasSubstr("utility 0."));
  EXPECT_THAT(text(ViewVerdict::LittleSurface), HasSubstr("registration\nunknown "));
  EXPECT_THAT(text(ViewVerdict::NotFree), ::testing::EndsWith("no rank: not free"));
}

TEST(PickText, OfAVoxelSaysIndexStateTsdfAndWeight) {
  const StepData data = dataOf(test::makeSyntheticRun());
  const TsdfVolume& volume = *data.volume;
  const auto& voxels = volume.voxels();
  const auto seen = std::ranges::find_if(voxels, [](const TsdfVoxel& v) { return v.weight > 0; });
  const auto unseen = std::ranges::find_if(voxels, [](const TsdfVoxel& v) { return v.weight == 0; });
  ASSERT_TRUE(seen != voxels.end() && unseen != voxels.end());
  const auto indexOf = [&](auto at) {
    return volume.geometry().voxel(static_cast<std::size_t>(at - voxels.begin()));
  };
  const Eigen::Vector3i v = indexOf(seen);
  const std::string text = textOfPicked(data, PickedKind::Voxel, 0, v);
  EXPECT_THAT(text, HasSubstr("voxel " + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " +
                              std::to_string(v.z()) + ": "));
  EXPECT_THAT(text, HasSubstr("; tsdf "));
  EXPECT_THAT(text, HasSubstr("weight " + std::to_string(seen->weight)));
  EXPECT_THAT(textOfPicked(data, PickedKind::Voxel, 0, indexOf(unseen)),
              HasSubstr("unknown; no tsdf, weight 0: never observed"));
}

}  // namespace
}  // namespace vantage
