// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/message_traits.h>

#include <string>

namespace sas_motion::ros_side {

/// A topic that a system listens to.
struct MessageSource {
  enum class Need {
    Required,    ///< without it nothing can be estimated
    Optional,    ///< taken where it is there
    NamedAlone,  ///< taken where a topic of just this name is there; another of its type is not meant
  };

  std::string name;   ///< in services, diagnostics and the manifest; ~NAME_topic and topics.NAME set its topic
  std::string topic;  ///< empty: none
  std::string type;   ///< of its messages
  std::string md5;    ///< of their definition
  std::string use;    ///< what is missing without it, in plain words
  Need need = Need::Optional;
  bool enabled = true;
  bool may_fall_silent = false;      ///< it is needed at the start alone
  bool must_speak = false;           ///< a user listed it: say where no message has come
  std::string wanted_topic = topic;  ///< the configured one, also where a bag has none
};

/// A source of messages of this type.
template <class Message>
MessageSource sourceOf(const std::string& name, const std::string& topic, const std::string& use) {
  using namespace ros::message_traits;
  return {name, topic, DataType<Message>::value(), MD5Sum<Message>::value(), use};
}

}  // namespace sas_motion::ros_side
