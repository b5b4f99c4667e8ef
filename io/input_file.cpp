#include "io/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>

#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

std::string wanted(const fs::path& file, std::string_view named_by) {
  if (named_by.empty()) return file.string();
  return file.string() + " (named by " + std::string(named_by) + ")";
}

}  // namespace

std::ifstream openInput(const fs::path& file, std::string_view named_by) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) {
    throw DataError(wanted(file, named_by) + ": no such file");
  }
  if (status.type() == fs::file_type::directory) {
    throw DataError(wanted(file, named_by) + ": is a folder, expected a file");
  }
  if (status.type() != fs::file_type::regular && fs::exists(status)) {  // opening a pipe waits for its writer
    throw DataError(wanted(file, named_by) + ": is a pipe or a device, expected a regular file");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw DataError(wanted(file, named_by) + ": cannot be read: " + std::strerror(errno));
  return stream;
}

std::string readWhole(const fs::path& file, std::string_view named_by, std::size_t largest) {
  std::ifstream stream = openInput(file, named_by);
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (!error && size > largest) {
    throw DataError(wanted(file, named_by) + ": has " + std::to_string(size) + " bytes, expected at most " +
                    std::to_string(largest));
  }
  std::string content(error ? 0 : size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw DataError(wanted(file, named_by) + ": reading failed: " + std::strerror(errno));
  return content;
}

}  // namespace thermovox
