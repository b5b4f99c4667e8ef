#include "tests/benchmark/growth.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "projection/error.hpp"

namespace thermovox::bench {

Linearity linearity(const std::vector<GrowthPoint>& curve) {
  double products = 0.0, squares = 0.0;
  for (const GrowthPoint& point : curve) {
    products += point.scans * point.total_cpu_s;
    squares += static_cast<double>(point.scans) * point.scans;
  }
  Linearity result{.seconds_a_scan = products / squares};
  for (const GrowthPoint& point : curve) {
    const double distance = std::abs(point.total_cpu_s - result.seconds_a_scan * point.scans);
    result.worst = std::max(result.worst, distance / curve.back().total_cpu_s);
  }
  const std::size_t quarter = curve.size() / 4;
  const double first = curve[quarter - 1].total_cpu_s;
  const double last = curve.back().total_cpu_s - curve[curve.size() - quarter - 1].total_cpu_s;
  result.last_to_first = last / first;
  return result;
}

void writeGrowthCsv(const std::filesystem::path& path, const std::vector<GrowthPoint>& curve) {
  std::ofstream file(path);
  file << "scans,cpu_ms,total_cpu_s,memory_mb\n";
  for (const GrowthPoint& point : curve)
    file << point.scans << ',' << point.cpu_ms << ',' << point.total_cpu_s << ',' << point.memory_mb << '\n';
  if (!file.flush()) throw DataError("cannot write " + path.string());
}

}  // namespace thermovox::bench
