// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <fmt/format.h>
#include <ros/ros.h>

#include <memory>
#include <string>

#include "sas_motion/config/yaml_section.hpp"

/// What the servers behind all nodelets share.
namespace sas_motion::ros_side {

/// Replaces `value` by a private parameter where there is one. Throws ConfigError.
template <class T>
void readParameter(const ros::NodeHandle& own, const std::string& key, T& value) {
  if (own.hasParam(key) && !own.getParam(key, value)) throw ConfigError(fmt::format("~{} is of the wrong type", key));
}

/// Publishes what `diagnose` writes on /diagnostics as `name`; two nodelets of one manager have two names.
template <class Server>
std::unique_ptr<diagnostic_updater::Updater> makeUpdater(
    const ros::NodeHandle& node, const ros::NodeHandle& own, const std::string& name, Server* server,
    void (Server::*diagnose)(diagnostic_updater::DiagnosticStatusWrapper&)) {
  auto updater = std::make_unique<diagnostic_updater::Updater>(node, own, own.getNamespace());
  updater->setHardwareID("sas_motion");
  updater->add(name, server, diagnose);
  return updater;
}

}  // namespace sas_motion::ros_side
