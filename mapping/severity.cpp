#include "mapping/severity.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "projection/error.hpp"

namespace thermovox {
namespace {

void checkClasses(const std::vector<SeverityClass>& classes, const char* basis) {
  double lower = 0.0;
  std::set<std::string> names;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const std::string place = std::string(basis) + "[" + std::to_string(i) + "]";
    if (classes[i].name.empty()) throw ConfigError(place + ".name: is empty, expected a word");
    if (!names.insert(classes[i].name).second) {
      throw ConfigError(place + ".name: '" + classes[i].name + "' is the name of a class before it too");
    }
    const bool last = i + 1 == classes.size();
    const double up_to = classes[i].up_to;
    if (last && up_to == std::numeric_limits<double>::infinity()) return;
    if (last) {
      throw ConfigError(place + ".up_to: is " + std::to_string(up_to) +
                        " C, expected none: the last class has no end");
    }
    if (!(up_to > lower && std::isfinite(up_to))) {
      throw ConfigError(place + ".up_to: is " + std::to_string(up_to) + " C, expected a number above " +
                        std::to_string(lower) + " C");
    }
    lower = up_to;
  }
}

}  // namespace

const SeverityClass* SeverityTable::classOf(SeverityBasis basis, double rise) const {
  if (!(rise > 0.0)) return nullptr;
  const std::vector<SeverityClass>& all = classes(basis);
  const auto found =
      std::find_if(all.begin(), all.end(), [rise](const SeverityClass& one) { return rise <= one.up_to; });
  return found == all.end() ? nullptr : &*found;
}

void SeverityTable::validate() const {
  if (name.empty()) throw ConfigError("name: is empty, expected that of the table");
  if (edition.empty()) throw ConfigError("edition: is empty, expected that of the table");
  if (over_ambient.empty() && over_similar.empty()) {
    throw ConfigError("over_ambient: has no class, nor has over_similar; expected one at least");
  }
  checkClasses(over_ambient, "over_ambient");
  checkClasses(over_similar, "over_similar");
}

SeverityTable netaSeverity() {
  const SeverityClass possible{0.0, "possible", "a deficiency is possible: investigate"};
  const SeverityClass probable{0.0, "probable", "a deficiency is probable: repair when there is time"};
  const SeverityClass monitor{0.0, "monitor", "watch it until it can be corrected"};
  const SeverityClass major{std::numeric_limits<double>::infinity(), "major", "repair at once"};
  const auto upTo = [](SeverityClass one, double celsius) {
    one.up_to = celsius;
    return one;
  };
  return {.name = "ANSI/NETA MTS, table 100.18",
          .edition = "2019",
          .over_ambient = {upTo(possible, 10.0), upTo(probable, 20.0), upTo(monitor, 40.0), major},
          .over_similar = {upTo(possible, 3.0), upTo(probable, 15.0), major}};
}

}  // namespace thermovox
