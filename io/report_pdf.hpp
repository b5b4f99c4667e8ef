#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/atomic_file.hpp"

namespace thermovox {

/// A browser that can print: chromium, chromium-browser or google-chrome, the first that the PATH has. Throws
/// DataError saying what to install where there is none. For verbs that work for long before they print: ask
/// first.
[[nodiscard]] std::filesystem::path findBrowser();

/// How a document is printed.
struct PdfPrinting {
  std::filesystem::path browser;  ///< as findBrowser() gives it
  int seconds = 120;              ///< after which the browser is taken to hang
  std::int64_t date = 0;          ///< that the file says it is of, Unix seconds: not the clock's
};

/// Prints an HTML document as PDF (A4, as its style says): the browser runs without window and network in a
/// folder of its own, which is gone afterwards. Throws DataError naming the browser when it fails, hangs or
/// leaves no PDF, and as AtomicFile does.
void writePdf(const std::filesystem::path& path, const std::string& html, const PdfPrinting& printing,
              Existing existing);

}  // namespace thermovox
