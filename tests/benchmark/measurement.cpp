#include "tests/benchmark/measurement.hpp"

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace thermovox::bench {
namespace {

double seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A line of /proc/self/status in bytes, such as VmRSS.
double statusBytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name + ":")) return 1024.0 * std::stod(line.substr(name.size() + 1));
  }
  return 0.0;
}

/// From here on VmHWM is the largest resident memory since now.
void forgetPeak() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

Measurement measure(const std::function<EnginePointer()>& make, const Workload& workload) {
  keepScansOutOfTheHeap();
  Measurement result;
  std::vector<MappedReturn> scan = workload.scan(0);  // so that its memory is there before
  malloc_trim(0);
  const double before = residentBytes();
  forgetPeak();
  const EnginePointer engine = make();
  Stopwatch watch;
  for (int i = 0; i < workload.scans; ++i) {
    scan = {};  // never two of them in memory, which is the engine's
    scan = workload.scan(i);
    watch.start();
    engine->insert(scan);
    watch.stop();
    result.points += static_cast<double>(scan.size());
  }
  result.peak_bytes = statusBytes("VmHWM") - before;
  malloc_trim(0);
  result.memory_bytes = residentBytes() - before;
  result.cpu_s = watch.cpu();
  result.wall_s = watch.wall();
  result.busier_half_s = watch.busierHalf();
  result.cells = engine->cells();
  return result;
}

/// The child's part; never returns.
[[noreturn]] void measureAndSend(const std::function<EnginePointer()>& make, const Workload& workload,
                                 int pipe) {
  try {
    const Measurement result = measure(make, workload);
    _exit(write(pipe, &result, sizeof result) == sizeof result ? 0 : 1);
  } catch (const std::exception& error) {
    std::cerr << "benchmark: " << error.what() << '\n';
    _exit(1);
  }
}

}  // namespace

void keepScansOutOfTheHeap() {
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
}

double residentBytes() {
  return statusBytes("VmRSS");
}

Measurement measureInChild(const std::function<EnginePointer()>& make, const Workload& workload) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("cannot make a pipe");
  const pid_t child = fork();
  if (child == 0) measureAndSend(make, workload, ends[1]);
  close(ends[1]);
  Measurement result;
  const bool whole = child > 0 && read(ends[0], &result, sizeof result) == sizeof result;
  close(ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  if (!whole) throw std::runtime_error("the process of a measurement failed");
  return result;
}

Stopwatch::Clocks Stopwatch::now() {
  return {seconds(CLOCK_MONOTONIC), seconds(CLOCK_PROCESS_CPUTIME_ID), seconds(CLOCK_THREAD_CPUTIME_ID)};
}

void Stopwatch::start() {
  started_ = now();
}

void Stopwatch::stop() {
  const Clocks stopped = now();
  sum_.wall += stopped.wall - started_.wall;
  sum_.process += stopped.process - started_.process;
  sum_.thread += stopped.thread - started_.thread;
}

}  // namespace thermovox::bench
