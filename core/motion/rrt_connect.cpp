#include "core/motion/rrt_connect.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/datastructures/NearestNeighborsLinear.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include <chrono>
#include <random>

namespace vantage {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using Point = ob::RealVectorStateSpace::StateType;

JointVector valuesOf(const ob::State* state, int size) {
  return JointVector::Map(state->as<Point>()->values, size);
}

/// Uniform samples from our own generator: OMPL's are seeded once for the whole process. The mapping to reals
/// is written out because that of the standard library is not fixed. Counts what it draws.
class SeededSampler : public ob::StateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::uint64_t seed, int& drawn)
      : StateSampler(space), engine_(seed), drawn_(drawn) {}

  void sampleUniform(ob::State* state) override {
    const auto& bounds = space_->as<ob::RealVectorStateSpace>()->getBounds();
    for (unsigned axis = 0; axis < bounds.low.size(); ++axis)
      value(state, axis) = bounds.low[axis] + unit() * (bounds.high[axis] - bounds.low[axis]);
    ++drawn_;
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    for (unsigned axis = 0; axis < space_->getDimension(); ++axis)
      value(state, axis) = near->as<Point>()->values[axis] + (2.0 * unit() - 1.0) * distance;
    space_->enforceBounds(state);
    ++drawn_;
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    sampleUniformNear(state, mean, deviation);  // not drawn by RRT-Connect
  }

 private:
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  static double& value(ob::State* state, unsigned axis) { return state->as<Point>()->values[axis]; }

  std::mt19937_64 engine_;
  int& drawn_;
};

class SegmentValidator : public ob::MotionValidator {
 public:
  SegmentValidator(const ob::SpaceInformationPtr& space, const RrtQuery& query)
      : MotionValidator(space), query_(query) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const auto size = static_cast<int>(query_.start.size());
    return query_.segment_valid(valuesOf(from, size), valuesOf(to, size));
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    const bool valid = checkMotion(from, to);
    if (!valid) {
      last_valid.second = 0.0;
      if (last_valid.first) si_->copyState(last_valid.first, from);
    }
    return valid;
  }

 private:
  const RrtQuery& query_;
};

ob::SpaceInformationPtr makeSpace(const RrtQuery& query, int& drawn) {
  const auto size = static_cast<int>(query.start.size());
  auto space = std::make_shared<ob::RealVectorStateSpace>(size);
  ob::RealVectorBounds bounds(size);
  for (int axis = 0; axis < size; ++axis) {
    bounds.setLow(axis, query.lower[axis]);
    bounds.setHigh(axis, query.upper[axis]);
  }
  space->setBounds(bounds);
  space->setStateSamplerAllocator([&query, &drawn](const ob::StateSpace* s) {
    return std::make_shared<SeededSampler>(s, query.seed, drawn);
  });
  auto info = std::make_shared<ob::SpaceInformation>(space);
  info->setStateValidityChecker(
      [&query, size](const ob::State* s) { return query.valid(valuesOf(s, size)); });
  info->setMotionValidator(std::make_shared<SegmentValidator>(info, query));
  info->setup();
  return info;
}

ob::ProblemDefinitionPtr makeProblem(const ob::SpaceInformationPtr& info, const RrtQuery& query) {
  ob::ScopedState<ob::RealVectorStateSpace> start(info), goal(info);
  for (int axis = 0; axis < query.start.size(); ++axis) {
    start[axis] = query.start[axis];
    goal[axis] = query.goal[axis];
  }
  auto problem = std::make_shared<ob::ProblemDefinition>(info);
  problem->setStartAndGoalStates(start, goal);
  return problem;
}

}  // namespace

RrtResult rrtConnect(const RrtQuery& query) {
  RrtResult result;
  if (query.iterations <= 0) return result;
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  const ob::SpaceInformationPtr info = makeSpace(query, result.iterations);
  const ob::ProblemDefinitionPtr problem = makeProblem(info, query);
  og::RRTConnect planner(info);
  planner.setRange(query.range);
  planner.setProblemDefinition(problem);
  // OMPL's default structure draws its pivots from the process-wide generator.
  planner.setNearestNeighbors<ompl::NearestNeighborsLinear>();
  planner.setup();
  result.iterations = 0;

  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const ob::PlannerTerminationCondition done([&] {
    if (result.iterations >= query.iterations) return true;
    if (std::chrono::duration<double>(Clock::now() - start).count() > query.safety_time_s)
      result.timed_out = true;
    return result.timed_out;
  });
  if (planner.solve(done) != ob::PlannerStatus::EXACT_SOLUTION) return result;
  result.timed_out = false;
  for (const ob::State* state : problem->getSolutionPath()->as<og::PathGeometric>()->getStates())
    result.path.push_back(valuesOf(state, static_cast<int>(query.start.size())));
  return result;
}

}  // namespace vantage
