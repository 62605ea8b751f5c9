// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/threads/quick_callbacks.h"

#include <boost/make_shared.hpp>
#include <utility>

#include "node/threads/quick_turn.h"

namespace hgrid {

/// A callback that was passed on. It counts for as long as it exists. A callback queue destroys it after its call.
class QuickCallbacks::Passed : public ros::CallbackInterface {
 public:
  Passed(ros::CallbackInterfacePtr callback, std::shared_ptr<std::atomic<int>> count)
      : callback_(std::move(callback)), count_(std::move(count)) {
    ++*count_;
  }
  ~Passed() override {
    callback_.reset();
    --*count_;
  }
  CallResult call() override { return callback_->call(); }
  bool ready() override { return callback_->ready(); }

 private:
  ros::CallbackInterfacePtr callback_;
  std::shared_ptr<std::atomic<int>> count_;
};

void QuickCallbacks::addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t owner) {
  if (!run(*callback)) others_.addCallback(boost::make_shared<Passed>(callback, passed_), owner);
}

/// Runs a callback at once if that is allowed. @returns false if another thread must run it
bool QuickCallbacks::run(ros::CallbackInterface& callback) {
  const std::unique_lock<std::recursive_mutex> lock(mutex_, std::try_to_lock);
  if (!lock || stopped_ || running_ || *passed_ > 0 || Clock::now() - ended_ < kPause) return false;
  running_ = true;
  bool done = true;
  try {
    const QuickTurn turn;
    callback.call();
  } catch (...) {  // usually TakesLong
    done = false;
  }
  running_ = false;
  ended_ = Clock::now();
  return done;
}

void QuickCallbacks::stop() {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  stopped_ = true;
}

}  // namespace hgrid
