#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "apps/arguments.hpp"
#include "apps/verbs.hpp"
#include "projection/error.hpp"

namespace {

/// stdout carries results, everything else goes to stderr.
void logToStderr() {
  auto logger = spdlog::stderr_color_mt("thermovox");
  logger->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(std::move(logger));
}

int fail(const char* what, int code) {
  std::cerr << "thermovox: " << what << '\n';
  return code;
}

constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kUnobservable = 3;

int run(int argc, char** argv) {
  CLI::App app{
      "thermovox: thermal 3D maps of industrial plants from a laser, a thermal camera and poses.\n"
      "Units: metres, seconds, degrees Celsius. Exit codes: 0 done, 1 the job failed, 2 wrong usage, "
      "3 the data cannot determine the answer."};
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("thermovox ") + THERMOVOX_VERSION);
  thermovox::addSimulate(app);
  thermovox::addMap(app);
  thermovox::addMerge(app);
  thermovox::addHotspots(app);
  thermovox::addDiff(app);
  thermovox::addReport(app);
  thermovox::addLocate(app);
  thermovox::addExport(app);
  thermovox::addCalibrate(app);
  thermovox::addImage(app);
  thermovox::addInfo(app);
  thermovox::addOverlay(app);
  try {
    app.parse(argc, argv);  // runs the verb's callback
  } catch (const CLI::ParseError& error) {
    if (app.exit(error, std::cout, std::cerr) != 0) return kWrongUsage;
  }
  if (!std::cout.flush()) return fail("the results cannot be written to standard output", kFailed);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    logToStderr();
    return run(argc, argv);
  } catch (const thermovox::UnobservableError& error) {
    return fail(error.what(), kUnobservable);
  } catch (const thermovox::UsageError& error) {
    return fail(error.what(), kWrongUsage);
  } catch (const thermovox::Error& error) {
    return fail(error.what(), kFailed);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail((error.path1().string() + ": " + error.code().message()).c_str(), kFailed);
  } catch (const std::bad_alloc&) {
    return fail("out of memory", kFailed);
  } catch (const std::exception& error) {
    return fail((std::string("unexpected error: ") + error.what()).c_str(), kFailed);
  }
}
