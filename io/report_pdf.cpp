#include "io/report_pdf.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <thread>
#include <vector>

#include "projection/error.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;

/// A folder that is gone with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "thermovox-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw DataError(name + ": no folder could be made: " + std::strerror(errno));
    }
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

std::string readAll(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeAll(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush())
    throw DataError(file.string() + ": could not be written, expected room in the temporary folder");
}

/// Every byte that an address may not hold as it is becomes %XX.
std::string fileUrl(const fs::path& file) {
  std::string url = "file://";
  for (const char c : file.string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("/-_.~").find(c) != std::string_view::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

/// In the child: what may be called between fork and exec. The group makes that it can be ended with all that
/// it has started, the signal that it does not outlive this program.
[[noreturn]] void becomeBrowser(const std::vector<char*>& arguments, int words) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(words, STDOUT_FILENO);
  dup2(words, STDERR_FILENO);
  execv(arguments.front(), arguments.data());
  _exit(127);
}

/// Runs it to its end, its words going to a file. Its status as waitpid gives it, or -1 when the time is
/// over.
int run(std::vector<std::string> command, const fs::path& words, int seconds) {
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  const int out = open(words.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const pid_t child = fork();
  if (child == 0) becomeBrowser(arguments, out);
  close(out);
  if (child < 0) throw DataError(command.front() + ": could not be started: " + std::strerror(errno));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(-child, SIGKILL);
      waitpid(child, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(-child, SIGKILL);  // what it may have left behind
  return status;
}

/// The last line that is not empty.
std::string lastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.find_last_of('\n') + 1);
}

/// The browser writes the clock's time into the file; this date takes its place, in as many letters.
void setDates(std::string& pdf, std::int64_t date) {
  using namespace std::chrono;
  const sys_seconds time{seconds(date)};
  const year_month_day day(floor<days>(time));
  const hh_mm_ss clock(time - floor<days>(time));
  const std::string text =
      fmt::format("(D:{:04}{:02}{:02}{:02}{:02}{:02}+00'00')", static_cast<int>(day.year()),
                  static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()), clock.hours().count(),
                  clock.minutes().count(), clock.seconds().count());
  for (const std::string_view key : {"/CreationDate ", "/ModDate "}) {
    for (std::size_t at = pdf.find(key); at != std::string::npos; at = pdf.find(key, at + 1)) {
      const std::size_t begin = at + key.size();
      const std::size_t end = pdf.find(')', begin);
      if (pdf.compare(begin, 3, "(D:") == 0 && end - begin + 1 == text.size())
        pdf.replace(begin, text.size(), text);
    }
  }
}

std::string print(const std::string& html, const PdfPrinting& printing) {
  const TemporaryFolder folder;
  writeAll(folder / "report.html", html);
  const fs::path pdf = folder / "report.pdf";
  const int status = run(
      {printing.browser.string(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
       "--no-first-run", "--disable-extensions", "--disable-background-networking", "--no-pdf-header-footer",
       "--user-data-dir=" + (folder / "profile").string(), "--print-to-pdf=" + pdf.string(),
       fileUrl(folder / "report.html")},
      folder / "words", printing.seconds);
  if (status == -1) {
    throw DataError(fmt::format(
        "{}: has not printed the report within {} s, expected a browser that prints without a window",
        printing.browser.string(), printing.seconds));
  }
  std::string bytes = readAll(pdf);
  if (status != 0 || !bytes.starts_with("%PDF-")) {
    throw DataError(
        fmt::format("{}: ended with status {} and {}, expected a PDF; its last words: {}",
                    printing.browser.string(), WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
                    bytes.empty() ? "no file" : "another file", lastLine(readAll(folder / "words"))));
  }
  setDates(bytes, printing.date);
  return bytes;
}

}  // namespace

std::filesystem::path findBrowser() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"}) {
    std::string_view rest = path != nullptr ? path : "";
    while (!rest.empty()) {
      const std::string_view folder = rest.substr(0, rest.find(':'));
      rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
      const fs::path file = fs::path(folder) / name;
      std::error_code ignored;
      if (!folder.empty() && fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0)
        return file;
    }
  }
  throw DataError(
      "no browser to print a PDF with is on the PATH (looked for chromium, chromium-browser, google-chrome), "
      "expected "
      "one: install Debian's package chromium (.ci/packages.sh report), or write the report as .html");
}

void writePdf(const std::filesystem::path& path, const std::string& html, const PdfPrinting& printing,
              Existing existing) {
  checkOutput(path, existing);
  AtomicFile file(path, existing);
  file.write(print(html, printing));
  file.commit();
}

}  // namespace thermovox
