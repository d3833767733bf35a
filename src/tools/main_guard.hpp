// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <vector>

namespace sas_motion {

/// Parses the arguments, without those of roslaunch (__name:=, __log:=), and runs a tool. The exit status is 0 on
/// success, 1 with one plain sentence on standard error where `run` throws, 2 on wrong usage.
inline int runTool(CLI::App& app, int argc, char** argv, const std::function<void()>& run) {
  try {
    std::vector<const char*> arguments(argv, argv + argc);
    const auto of_roslaunch = [](const char* a) { return std::strncmp(a, "__", 2) == 0 && std::strstr(a, ":="); };
    arguments.erase(std::remove_if(arguments.begin(), arguments.end(), of_roslaunch), arguments.end());
    app.parse(static_cast<int>(arguments.size()), arguments.data());
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // makes a write beyond the file size limit fail instead of ending the process
  try {
    run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 1;
  }
  return 0;
}

}  // namespace sas_motion
