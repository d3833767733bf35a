// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>

#include <functional>
#include <memory>
#include <utility>

#include "ros/inbox.hpp"
#include "ros/settings.hpp"
#include "sas_motion/session/session.hpp"

namespace sas_motion::ros_side {

constexpr std::uint32_t kQueue = 1000;  // messages kept for a slow callback or subscriber

/// One system on its way through messages, live and from a bag alike: its sources, what their messages become, and the
/// session that takes it. The first fix sets the datum, unless the settings do. A system's own run says in its
/// constructor what each source's messages become.
class SystemRun {
 public:
  /// A message on its way to a run.
  using Delivery = std::function<void(SystemRun&)>;

  /// `transforms` outlives the run.
  SystemRun(const MapSettings& settings, std::vector<MessageSource> sources, const tf2::BufferCore& transforms);
  virtual ~SystemRun() = default;
  SystemRun(const SystemRun&) = delete;
  SystemRun& operator=(const SystemRun&) = delete;

  const std::vector<MessageSource>& sources() const { return sources_; }
  virtual Session& session() = 0;
  const Session& session() const { return const_cast<SystemRun*>(this)->session(); }
  Inbox& inbox() { return inbox_; }
  const Inbox& inbox() const { return inbox_; }
  const OutputFrame& frame() const { return frame_; }
  void setDatum(const Geodetic& datum) { frame_.map.emplace(datum); }

  /// Takes a serialised message of a source.
  void take(std::size_t source, ros::serialization::IStream& message) { handlers_[source].read(message); }
  /// Subscribes to the topics of all sources; each message comes to `receive` as a delivery.
  std::vector<ros::Subscriber> subscribe(ros::NodeHandle& node, const std::function<void(Delivery)>& receive) const;
  /// The end of the data: gives up on messages that wait for their frame, and settles what is open.
  void finish();
  /// Begins anew; the datum stays, and which sources are enabled.
  virtual void restart();

  /// Why estimators have not started, with the topic that is to blame; empty where they have.
  virtual std::string waitsFor() const { return ""; }
  /// What is wrong with the data, a sentence each.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Figures of this system alone, for /diagnostics.
  virtual std::vector<std::pair<std::string, std::string>> details() const { return {}; }

 protected:
  /// Sets what a source's messages become: `take(message)`.
  template <class Message, class Take>
  void listen(std::size_t source, const Take& take);
  /// The same of a sensor that sits somewhere: `convert(message, T_base_sensor)`, see Inbox::receive().
  template <class Message, class Convert>
  void listenAt(std::size_t source, const Convert& convert) {
    listen<Message>(source,
                    [this, source, convert](const Message& message) { inbox_.receive(message, source, convert); });
  }

  /// What is wrong with a source that gave no reading: it is disabled, its frame is unknown, or `otherwise`.
  std::string lackOf(std::size_t source, const std::string& otherwise) const;

  OutputFrame frame_;

 private:
  struct Handler {
    std::function<void(ros::serialization::IStream&)> read;
    std::function<void(const void*)> take;  // a message of the source's type
    std::function<ros::Subscriber(ros::NodeHandle&, const std::function<void(Delivery)>&)> subscribe;
  };

  std::vector<MessageSource> sources_;
  Inbox inbox_;
  std::vector<Handler> handlers_;
};

template <class Message, class Take>
void SystemRun::listen(std::size_t source, const Take& take) {
  Handler& handler = handlers_[source];
  handler.take = [take](const void* message) { take(*static_cast<const Message*>(message)); };
  handler.read = [take, message = std::make_shared<Message>()](ros::serialization::IStream& stream) {
    ros::serialization::deserialize(stream, *message);
    take(*message);
  };
  handler.subscribe = [source, topic = sources_[source].topic](ros::NodeHandle& node,
                                                               const std::function<void(Delivery)>& receive) {
    using Pointer = boost::shared_ptr<Message const>;
    const boost::function<void(const Pointer&)> on_message = [source, receive](const Pointer& message) {
      receive([source, message](SystemRun& run) { run.handlers_[source].take(message.get()); });
    };
    return node.subscribe<Message>(topic, kQueue, on_message, {}, ros::TransportHints().tcpNoDelay());
  };
}

}  // namespace sas_motion::ros_side
