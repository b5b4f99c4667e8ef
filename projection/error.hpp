#pragma once

#include <stdexcept>
#include <string>

namespace thermovox {

/// What every failure of the library derives from. The message is one sentence for a person: the field or
/// file (and line), what was found and what was expected.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option, a rig or a mission description that cannot be used as it stands.
class ConfigError : public Error {
 public:
  using Error::Error;
};

/// A file or a stream whose content is damaged, inconsistent or missing.
class DataError : public Error {
 public:
  using Error::Error;
};

/// The data are sound but cannot determine the answer (exit code 3 of the program).
class UnobservableError : public Error {
 public:
  using Error::Error;
};

}  // namespace thermovox
