// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag/reprocess.hpp"

#include <fmt/format.h>
#include <tf2_msgs/TFMessage.h>

#include <filesystem>
#include <optional>

#include "bag/topics.hpp"

namespace sas_motion::ros_side {
namespace {

/// What to do with the messages of a connection.
struct Route {
  enum Kind { kAnother, kOfAnEarlierRun, kTransforms, kSensor } kind = kAnother;
  std::optional<std::uint32_t> output;  // its connection there
};

std::vector<Route> routesOf(const std::vector<BagConnection>& connections, const BagRun& run,
                            const std::vector<std::string>& estimators, const std::string& file) {
  std::vector<Route> routes(connections.size());
  for (const auto& connection : connections) {
    auto& kind = routes[connection.index].kind;
    if (connection.type == "tf2_msgs/TFMessage") kind = Route::kTransforms;
    if (isEstimate(connection.topic, estimators)) kind = Route::kOfAnEarlierRun;
    if (!run.isSensor(connection)) continue;
    if (kind == Route::kOfAnEarlierRun)
      throw std::runtime_error(
          fmt::format("{}: topic {} is a sensor's, and an estimator would write it too; leave that estimator out", file,
                      connection.topic));
    kind = Route::kSensor;
  }
  return routes;
}

}  // namespace

std::unique_ptr<ReprocessSystem> makeReprocessSystem(const std::string& config) {
  std::string system = "towfish";
  if (config.empty()) return makeTowfishSystem(config);
  auto yaml = YamlSection::fromFile(config);
  yaml.text("system", system);
  if (system == "ins_gps_dvl" || system == "sins_dvl") return makeInsSystem(config);
  if (system != "towfish")
    yaml.fail("system", fmt::format("is '{}' but must be towfish, ins_gps_dvl or sins_dvl", system));
  return makeTowfishSystem(config);
}

ReprocessReport reprocess(const std::string& input, const std::string& folder,
                          const std::vector<std::string>& estimators, const ReprocessSystem& system,
                          const std::function<void(double)>& progress) {
  BagReader source(input);
  const std::filesystem::path out = std::filesystem::path(folder) / std::filesystem::path(input).filename();
  if (std::filesystem::exists(out) && std::filesystem::equivalent(out, input))
    throw std::runtime_error(
        fmt::format("{}: the output would replace the input; choose another folder with -o", input));

  ReprocessReport report;
  report.input = input;
  report.output = out;
  BagOutput bag(out);
  tf2::BufferCore transforms;
  const auto run =
      system.begin(source, input, estimators, {transforms, bag, (out.parent_path() / out.stem()).string()});
  std::vector<Route> routes = routesOf(source.connections(), *run, estimators, input);

  double done = 0;
  bool datum_written = false;
  tf2_msgs::TFMessage tf;
  while (const BagMessage* m = source.next()) {
    ++report.messages;
    Route& route = routes[m->connection->index];
    if (route.kind == Route::kOfAnEarlierRun) continue;
    if (!route.output) route.output = bag.connect(*m->connection);
    bag.write(*route.output, m->time, m->bytes);
    if (route.kind == Route::kTransforms && source.get(*m, tf))
      for (const auto& T : tf.transforms)
        transforms.setTransform(T, "bag", bareTopic(m->connection->topic) == "tf_static");
    if (route.kind == Route::kSensor) run->take(source, *m);
    if (!datum_written && run->frame()) {
      bag.writeLatched("datum", m->time, datumOf(*run->frame(), system.map(), m->time));
      datum_written = true;
    }
    if (report.messages % 1024 == 0) {
      const double now = (m->time - source.begin()).toSec();
      progress(now - done);
      done = now;
    }
  }
  report.duration = (source.end() - source.begin()).toSec();
  run->finish(report);
  bag.commit();
  run->commit();
  progress(report.duration - done);
  return report;
}

}  // namespace sas_motion::ros_side
