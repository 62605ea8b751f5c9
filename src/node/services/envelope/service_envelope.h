// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <boost/function.hpp>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "node/health/guarded.h"
#include "node/health/ledger.h"
#include "node/services/envelope/answer_tick.h"
#include "node/services/envelope/reply.h"
#include "node/threads/quick_turn.h"
#include "node/tick/newest_tick.h"
#include "node/wire/checked.h"

namespace hgrid {

/// One request of the service type `Service`, with all that a work needs.
template <class Service>
struct ServiceCall {
  const typename Service::Request& request;
  typename Service::Response& response;
  std::string caller;  ///< name of the node that sent the request, made safe for logs and messages
  AnswerTick& tick;    ///< the newest tick. Work that changes the world sets it to the first tick with the change.
  std::shared_ptr<const Tick>& written;  ///< the tick that the response says it is made from

  /// Makes the response from this tick, and writes that into the response.
  void answerFrom(std::shared_ptr<const Tick> chosen) {
    if (chosen == written) return;
    tick = AnswerTick(std::move(chosen));
    written = tick.get();
    writeTick(tick, response);
  }
};

/// Answers the requests of all services in one way.
///
/// A work is the function that does the work of one service. For every request, the envelope
/// - takes the newest tick,
/// - checks that the bytes of the request are a valid message,
/// - fills `header`, `world` and `success` of the response,
/// - turns a Refusal or any other exception of the work into a code,
/// - counts "<counter>.asked", "<counter>.refused.<CODE>" and "<counter>.failed.<CODE>".
/// - counts "<counter>.quick" if it was answered in a QuickTurn, which is in the thread that received it.
///
/// Callbacks run on the threads that serve the queue of the node handle. In a QuickTurn, a request that is refused or
/// fails throws TakesLong and counts nothing; the thread that answers it again refuses it.
class ServiceEnvelope {
 public:
  template <class Service>
  using Work = std::function<void(ServiceCall<Service>&)>;

  /// @param private_node  node handle whose namespace contains the services
  /// All other parameters must outlive the servers.
  ServiceEnvelope(const ros::NodeHandle& private_node, NewestTick newest, Ledger& ledger)
      : node_(private_node), newest_(std::move(newest)), ledger_(ledger) {}
  ServiceEnvelope(const ServiceEnvelope&) = delete;
  ServiceEnvelope& operator=(const ServiceEnvelope&) = delete;

  /// Advertises the service `name`. The names of its counters begin with its name.
  /// @returns the server, which must not outlive this object
  template <class Service>
  ros::ServiceServer serve(const std::string& name, Work<Service> work) {
    return serve<Service>(name, name, std::move(work));
  }
  /// As above.
  /// @param counter  the names of the counters begin with this
  /// @param blank    the response that each request starts with, before anything is known
  template <class Service>
  ros::ServiceServer serve(const std::string& name, const std::string& counter, Work<Service> work,
                           const typename Service::Response& blank = {}) {
    using Event = ros::ServiceEvent<Checked<typename Service::Request>, typename Service::Response>;
    const boost::function<bool(Event&)> callback = [this, work, blank, counters = Counters(counter)](Event& event) {
      const auto answered = [&] {
        event.getResponse() = blank;
        answer<Service>(event, counters, work);
      };
      if (QuickTurn::here()) return answeredQuickly(answered);
      return !guarded(ledger_, counters.failed.c_str(), answered);  // false: roscpp reports a failed call
    };
    return node_.advertiseService<Event>(name, callback);
  }

 private:
  /// Answers in a QuickTurn. @throws TakesLong after any error, so that another thread answers, counts and logs.
  /// roscpp would handle a std::exception itself, and would send its text as the answer.
  template <class Answer>
  static bool answeredQuickly(const Answer& answer) {
    try {
      answer();
    } catch (...) {
      throw TakesLong();
    }
    return true;
  }

  struct Counters {
    explicit Counters(const std::string& counter)
        : asked(counter + ".asked"),
          quick(counter + ".quick"),
          refused(counter + ".refused"),
          failed(counter + ".failed") {}
    std::string asked, quick, refused, failed;
  };

  template <class Service, class Event>
  void answer(const Event& event, const Counters& counters, const Work<Service>& work) const {
    typename Service::Response& response = event.getResponse();
    const bool is_quick = QuickTurn::here();
    if (!is_quick) ledger_.count(counters.asked);
    AnswerTick tick(newest_());
    std::shared_ptr<const Tick> written = tick.get();
    writeTick(tick, response);
    try {
      ServiceCall<Service> call{event.getRequest().value(), response, printable(event.getCallerName()), tick, written};
      writeSuccess(response);
      work(call);
    } catch (const Refusal& refusal) {
      QuickTurn::require(false);  // logging can take long
      writeRefusal(refusal, false, response);
      ledger_.refuse(counters.refused, refusal);
    } catch (...) {
      QuickTurn::require(false);
      writeRefusal(ledger_.fault(counters.failed.c_str()), true, response);
    }
    if (tick.get() != written) writeTick(tick, response);
    if (!is_quick) return;
    ledger_.count(counters.asked);  // not before: otherwise a request that another thread answers would count twice
    ledger_.count(counters.quick);
  }

  ros::NodeHandle node_;
  NewestTick newest_;
  Ledger& ledger_;
};

}  // namespace hgrid
