// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "question_stream.h"

#include <hgrid_proximity/Verdict.h>

#include <chrono>

#include "map_stream.h"

namespace hgrid {
namespace bench {
namespace {

namespace msg = ::hgrid_proximity;
using Clock = std::chrono::steady_clock;

constexpr double kBall = 0.3;      // [m] radius of sphere queries
constexpr double kCapsule = 0.05;  // [m] radius of segment queries

geometry_msgs::Point anywhere(Random& random) {
  geometry_msgs::Point point;
  point.x = random.uniform(-1.0, 3.0);
  point.y = random.uniform(-1.0, 3.0);
  point.z = random.uniform(0.0, 2.5);
  return point;
}

}  // namespace

QuestionStream::QuestionStream(const std::string& node)
    : sphere_(node_.serviceClient<msg::QuerySphere>(node + "/query_sphere", true)),
      segment_(node_.serviceClient<msg::QuerySegment>(node + "/query_segment", true)),
      thread_([this] { run(); }) {}

QuestionStream::~QuestionStream() {
  stopping_ = true;
  thread_.join();
}

void QuestionStream::noteIn(RoundTrips* trips) {
  const std::lock_guard<std::mutex> lock(mutex_);
  trips_ = trips;
}

void QuestionStream::run() {
  auto due = Clock::now();
  for (unsigned number = 0; !stopping_; ++number) {
    const std::chrono::duration<double> pause(random_.uniform(0.0, 2.0 / kRate));
    due += std::chrono::duration_cast<Clock::duration>(pause);
    std::this_thread::sleep_until(due);
    if (number % 2 == 0) askSphere();
    if (number % 2 == 1) askSegment();
    if (number % 20 == 0) askForMark();
  }
}

template <class Question>
void QuestionStream::time(ros::ServiceClient& client, Question& question, std::vector<double> RoundTrips::*kind) {
  const auto begin = Clock::now();
  const bool answered = client.call(question) && question.response.answer.success;
  const std::chrono::duration<double> took = Clock::now() - begin;
  if (!answered) ++failures_;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (trips_ != nullptr) (trips_->*kind).push_back(took.count());
}

void QuestionStream::askSphere() {
  msg::QuerySphere question;
  question.request.center = anywhere(random_);
  question.request.radius = kBall;
  time(sphere_, question, &RoundTrips::sphere);
}

void QuestionStream::askSegment() {
  msg::QuerySegment question;
  question.request.start = anywhere(random_);
  question.request.end = anywhere(random_);
  question.request.radius = kCapsule;
  time(segment_, question, &RoundTrips::segment);
}

void QuestionStream::askForMark() {
  msg::QuerySphere question;
  question.request.header.frame_id = "map";
  question.request.center.x = question.request.center.y = question.request.center.z = MapStream::middleOfMark();
  question.request.radius = 0.1 * MapStream::kEdge;
  if (!sphere_.call(question) || !question.response.answer.success) {
    ++failures_;
    return;
  }
  const bool marked = question.response.answer.verdict == msg::Verdict::HIT;
  if (looked_ && marked != marked_) ++replacements_;
  looked_ = true;
  marked_ = marked;
}

}  // namespace bench
}  // namespace hgrid
