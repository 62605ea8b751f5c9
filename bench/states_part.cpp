// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cstdio>

#include "bench/parts.h"
#include "bench/states/edge_race.h"
#include "bench/states/state_contest.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kBatch = 1000;     // states of each kind, and of each call
constexpr std::size_t kMostTries = 400;  // batches of random states that are searched for states of each kind
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
bool isInside(StateContest& contest, const double* state) {
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
Kinds findStates(StateContest& contest, Verdicts& verdicts) {
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

/// Median times per state [us], and the median of the ratios of successive turns.
struct Times {
  double hgrid = 0.0, fcl = 0.0, ratio = 0.0, exact_tests = 0.0;
};

Times race(StateContest& contest, const std::vector<double>& states, int turns) {
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

void play(const StateRobot& robot, const StateWorld& world, int turns, std::vector<Record>& records) {
  StateContest contest(robot, world);
  const std::size_t boxes = world.allBoxes().size();
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
  raceEdges(contest, boxes, kinds.clear, turns, records);
}

}  // namespace

void runStates(const Options& options, std::vector<Record>& records) {
  std::printf("\nstates of robots: time per state, hgrid in batches of %zu beside FCL in the way of MoveIt\n", kBatch);
  std::printf("edges of robots: time per edge, hgrid for all configurations beside FCL for one each 1 cm of motion\n");
  const std::vector<StateRobot> robots = stateRobots();
  if (robots.empty()) std::printf("  without robots: no example-robot-data in HGRID_TEST_DATA or ../shared/data\n");
  std::vector<std::size_t> sizes{10, 1000, 10000};
  if (!options.sizes.empty()) sizes = options.sizes;
  const std::optional<StateWorld> building = buildingWorld();
  for (const StateRobot& robot : robots) {
    if (!options.peer(robot.name)) continue;
    const int turns = options.quick ? 5 : 21;
    for (const std::size_t boxes : sizes) play(robot, randomWorld(boxes), turns, records);
    if (!building || !options.sizes.empty()) continue;
    std::printf("  in the map geb079; FCL has its leaves as boxes:\n");
    play(robot, *building, turns, records);
  }
}

}  // namespace bench
}  // namespace hgrid
