// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_event.h>
#include <ros/subscribe_options.h>

#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

#include "node/wire/message_bytes.h"

namespace hgrid {

using BytesEvent = ros::MessageEvent<const MessageBytes>;

/// Returns the options of a subscriber that receives the bytes of messages of any type. To accept only one type, set
/// `datatype` and `md5sum` of the result.
/// @param queue       how many messages may wait for the callback
/// @param most_bytes  MessageBytes::most_bytes of each message
inline ros::SubscribeOptions bytesOptions(const std::string& topic, std::uint32_t queue, std::size_t most_bytes,
                                          const boost::function<void(const BytesEvent&)>& on_message) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const BytesEvent&>(topic, queue, on_message, [most_bytes] {
    const auto message = boost::make_shared<MessageBytes>();
    message->most_bytes = most_bytes;
    return message;
  });
  return options;
}

/// Returns the MD5 of the type of a received message; empty: its publisher has not sent it.
inline std::string md5Of(const BytesEvent& event) {
  const ros::M_string& connection = event.getConnectionHeader();
  const auto md5 = connection.find("md5sum");
  return md5 == connection.end() ? "" : md5->second;
}

}  // namespace hgrid
