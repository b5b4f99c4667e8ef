#pragma once

#include <limits>
#include <string>
#include <vector>

namespace thermovox {

/// What a rise of temperature is counted from.
enum class SeverityBasis {
  over_ambient,  ///< the air
  over_similar,  ///< like parts under like load, or the surroundings on the same surface
};

/// The rises of a class: above the class before it (above 0 C for the first), up to `up_to`, which is in it.
struct SeverityClass {
  double up_to = std::numeric_limits<double>::infinity();  ///< C; the last class has no end
  std::string name;                                        ///< one short word, for tables and programs
  std::string action;                                      ///< what to do, for people
  friend bool operator==(const SeverityClass&, const SeverityClass&) = default;
};

/// How bad a rise of temperature is. Every rise above 0 C has exactly one class in each basis that the table
/// has: the classes are the intervals (0, a], (a, b], ..., (z, infinity).
struct SeverityTable {
  std::string name;
  std::string edition;
  std::vector<SeverityClass> over_ambient;  ///< ascending; empty where the table does not have the basis
  std::vector<SeverityClass> over_similar;

  [[nodiscard]] const std::vector<SeverityClass>& classes(SeverityBasis basis) const {
    return basis == SeverityBasis::over_ambient ? over_ambient : over_similar;
  }
  /// The class of a rise, C; null for one of 0 C or less, for NaN, and where the table lacks the basis.
  [[nodiscard]] const SeverityClass* classOf(SeverityBasis basis, double rise) const;
  /// Throws ConfigError naming the class and what is wrong with it: no class at all, limits that do not
  /// ascend from 0, a last class that ends, one without name or with the name of another.
  void validate() const;

  friend bool operator==(const SeverityTable&, const SeverityTable&) = default;
};

/// ANSI/NETA MTS, table 100.18, edition of 2019. The table is in whole degrees (over similar parts 1 to 3, 4
/// to 15, more than 15; over ambient 1 to 10, 11 to 20, 21 to 40, more than 40); what lies between two of its
/// classes belongs to the higher one here, and what lies below 1 C to the lowest.
[[nodiscard]] SeverityTable netaSeverity();

}  // namespace thermovox
