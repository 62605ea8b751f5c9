// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include "bench/parts.h"
#include "bench/states/fcl_states.h"
#include "bench/states/state_robots.h"
#include "bench/workload/random.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "hgrid_proximity/world/scene.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kBatch = 1000;     // states of each kind, and of each call
constexpr std::size_t kMostTries = 400;  // batches of random states that are searched for states of each kind
constexpr double kSide = 4.0;            // [m] edge of the cube around the base that has the boxes
constexpr double kFree = 0.45;           // [m] no box is nearer to the axis of the base

Eigen::Matrix3d randomTurn(Random& random) {
  Eigen::Quaterniond turn;
  do {
    for (int i = 0; i < 4; ++i) turn.coeffs()[i] = random.uniform(-1, 1);
  } while (turn.squaredNorm() > 1.0 || turn.squaredNorm() < 0.01);
  return turn.normalized().toRotationMatrix();
}

/// Returns boxes at random places and orientations. Few boxes are larger.
std::vector<OrientedBox> randomBoxes(std::size_t count) {
  Random random(count);
  const double least = count <= 100 ? 0.03 : 0.02, most = count <= 100 ? 0.10 : 0.03;
  std::vector<OrientedBox> boxes;
  while (boxes.size() < count) {
    OrientedBox box;
    for (int k = 0; k < 3; ++k) {
      box.size[k] = random.uniform(least, most);
      box.world_from_box.translation()[k] = random.uniform(-0.5 * kSide, 0.5 * kSide);
    }
    box.world_from_box.linear() = randomTurn(random);
    if (box.world_from_box.translation().head<2>().norm() - 0.5 * box.size.norm() > kFree) boxes.push_back(box);
  }
  return boxes;
}

/// A robot among boxes, prepared for both programs.
struct Contest {
  Contest(const StateRobot& tested, std::size_t count)
      : robot(tested),
        kinematics(robot.model),
        matrix(std::make_shared<const LinkMatrix>(robot.model, robot.rules, warnings)),
        narrow_phase(makeCoreNarrowPhase()) {
    Scene scene{SceneOptions{}};
    const std::vector<OrientedBox> boxes = randomBoxes(count);
    addRobot(scene);
    addBoxes(scene, boxes);
    StateCheckerOptions options;
    options.group = robot.group;
    checker = std::make_unique<StateChecker>(scene.commit(Time{1}, {}), kinematics, "robot", narrow_phase, options);
    batch.joints = robot.group;
    batch.world_from_root = Pose::Identity();
    batch.others.resize(kinematics.variables().size());
    fcl = std::make_unique<FclStates>(robot, *matrix, boxes, batch.others);
  }

  void addRobot(Scene& scene) {
    for (std::uint32_t i = 0; i < robot.model.links.size(); ++i) {
      RobotLink& link = robot.model.links[i];
      if (link.shapes.empty()) continue;
      Body body;
      body.name = "robot/" + link.name;
      body.frame = link.name;
      body.kind = BodyKind::link;
      body.robot = "robot";
      body.link = i;
      body.rigid_group = link.rigid_group;
      body.links = matrix;
      for (BodyShape& shape : link.shapes) shape.solid = narrow_phase->solidOf(shape.shape);
      body.shapes = link.shapes;
      scene.place(scene.add(body), Pose::Identity(), Time{1});
    }
  }
  void addBoxes(Scene& scene, const std::vector<OrientedBox>& boxes) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      Body body;
      body.name = "obstacle/b" + std::to_string(i);
      body.frame = "world";
      body.mobility = Mobility::fixed;
      const Shape shape = Shape::box(boxes[i].size);
      body.shapes.push_back({shape, Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones(), narrow_phase->solidOf(shape)});
      scene.place(scene.add(body), boxes[i].world_from_box, Time{1});
    }
  }

  std::vector<double> randomStates(Random& random, std::size_t count) const {
    std::vector<double> states;
    for (std::size_t i = 0; i < count; ++i) {
      for (const std::string& name : robot.group) {
        const JointVariable& variable = kinematics.variables()[std::size_t(kinematics.find(name))];
        states.push_back(std::isfinite(variable.lower) ? random.uniform(variable.lower, variable.upper)
                                                       : random.uniform(-M_PI, M_PI));
      }
    }
    return states;
  }

  StateRobot robot;
  Kinematics kinematics;
  std::vector<std::string> warnings;
  std::shared_ptr<const LinkMatrix> matrix;
  std::shared_ptr<NarrowPhase> narrow_phase;
  std::unique_ptr<StateChecker> checker;
  std::unique_ptr<FclStates> fcl;
  StateBatch batch;
  StateScratch scratch;
  StateAnswers answers;
};

/// The verdicts of both programs, compared one by one.
struct Verdicts {
  std::size_t states = 0, hits = 0;
  std::size_t inside = 0;  // only hgrid finds a contact, because one shape is inside another
  std::size_t wrong = 0;   // all other differences
};

/// States without contact and states in contact.
struct Kinds {
  std::vector<double> clear, contact;
};

/// Returns whether in all contacts of a state one shape is inside another.
bool isInside(Contest& contest, const double* state) {
  StateBatch batch = contest.batch;
  batch.positions.assign(state, state + contest.robot.group.size());
  StateRequest request;
  request.all_pairs = true;
  StateAnswers answers;
  contest.checker->checkStates(batch, request, contest.scratch, answers);
  return std::all_of(answers.pairs.begin(), answers.pairs.end(), [](const StatePair& pair) {
    return pair.proximity.status == Measure::contained || pair.proximity.status == Measure::containment_unknown;
  });
}

/// Finds a batch of states of each kind, or fewer if they are rare.
Kinds findStates(Contest& contest, Verdicts& verdicts) {
  Random random(7);
  Kinds kinds;
  const std::size_t width = contest.robot.group.size();
  for (std::size_t i = 0; i < kMostTries; ++i) {
    contest.batch.positions = contest.randomStates(random, kBatch);
    contest.checker->checkStates(contest.batch, {}, contest.scratch, contest.answers);
    for (std::size_t k = 0; k < kBatch; ++k) {
      const double* state = &contest.batch.positions[k * width];
      const StateAnswer& answer = contest.answers.states[k];
      const bool hit = answer.verdict == Verdict::hit, theirs = contest.fcl->isInContact(state);
      ++verdicts.states;
      verdicts.hits += hit ? 1 : 0;
      if (hit != theirs) ++(hit && isInside(contest, state) ? verdicts.inside : verdicts.wrong);
      std::vector<double>& list = hit ? kinds.contact : kinds.clear;
      if (list.size() < kBatch * width) list.insert(list.end(), state, state + width);
    }
    if (kinds.clear.size() == kBatch * width && kinds.contact.size() == kBatch * width) break;
  }
  return kinds;
}

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Median times per state [us], and the median of the ratios of successive turns.
struct Times {
  double hgrid = 0.0, fcl = 0.0, ratio = 0.0, exact_tests = 0.0;
};

/// Returns the processor time of this thread [us]. Other programs on a busy machine do not count.
double threadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}

Times race(Contest& contest, const std::vector<double>& states, int turns) {
  const std::size_t width = contest.robot.group.size();
  const double count = double(states.size()) / double(width);
  contest.batch.positions = states;
  std::vector<double> ours, theirs, ratios;
  const std::size_t tests_before = contest.fcl->exactTests();
  for (int turn = 0; turn < turns; ++turn) {
    double begin = threadTime();
    contest.checker->checkStates(contest.batch, {}, contest.scratch, contest.answers);
    ours.push_back((threadTime() - begin) / count);
    begin = threadTime();
    for (std::size_t i = 0; i < states.size(); i += width) contest.fcl->isInContact(&states[i]);
    theirs.push_back((threadTime() - begin) / count);
    ratios.push_back(theirs.back() / ours.back());
  }
  const double tests = double(contest.fcl->exactTests() - tests_before) / (count * turns);
  return {medianOf(ours), medianOf(theirs), medianOf(ratios), tests};
}

void play(const StateRobot& robot, std::size_t boxes, int turns, std::vector<Record>& records) {
  Contest contest(robot, boxes);
  Verdicts verdicts;
  const Kinds kinds = findStates(contest, verdicts);
  std::printf("  %-8s %6zu boxes: %zu states, %.1f %% in contact; verdicts differ: %zu inside meshes, %zu others%s\n",
              robot.name.c_str(), boxes, verdicts.states, 100.0 * double(verdicts.hits) / double(verdicts.states),
              verdicts.inside, verdicts.wrong, verdicts.wrong == 0 ? "" : "  WRONG");
  for (const bool clear : {true, false}) {
    const std::vector<double>& states = clear ? kinds.clear : kinds.contact;
    if (states.empty()) continue;
    const Times times = race(contest, states, turns);
    std::printf(
        "           %-10s hgrid %6.2f us  FCL %6.2f us  %5.2f times   (%zu states, FCL: %.1f exact tests each)\n",
        clear ? "clear" : "in contact", times.hgrid, times.fcl, times.ratio, states.size() / robot.group.size(),
        times.exact_tests);
    std::fflush(stdout);
    Record record("states");
    record.text("robot", robot.name).number("boxes", double(boxes)).text("which", clear ? "clear" : "in contact");
    record.number("hgrid_us", times.hgrid).number("fcl_us", times.fcl).number("ratio", times.ratio);
    record.number("fcl_exact_tests", times.exact_tests).number("inside", double(verdicts.inside));
    records.push_back(record.number("wrong", double(verdicts.wrong)).flag("correct", verdicts.wrong == 0));
  }
}

}  // namespace

void runStates(const Options& options, std::vector<Record>& records) {
  std::printf("\nstates of robots: time per state, hgrid in batches of %zu beside FCL in the way of MoveIt\n", kBatch);
  const std::vector<StateRobot> robots = stateRobots();
  if (robots.empty()) std::printf("  without robots: no example-robot-data in HGRID_TEST_DATA or ../shared/data\n");
  std::vector<std::size_t> sizes{10, 1000, 10000};
  if (!options.sizes.empty()) sizes = options.sizes;
  for (const StateRobot& robot : robots) {
    if (!options.peer(robot.name)) continue;
    for (const std::size_t boxes : sizes) play(robot, boxes, options.quick ? 5 : 21, records);
  }
}

}  // namespace bench
}  // namespace hgrid
