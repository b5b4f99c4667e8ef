#include "io/folder_events.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Change = FolderEvents::Change;
using Changes = FolderEvents::Changes;
using Clock = std::chrono::steady_clock;

constexpr auto kSoon = 20s;      // for what must come, on any machine
constexpr auto kAWhile = 200ms;  // for what must not

class KernelEvents : public testing::Test {
 protected:
  KernelEvents() { events.watch(folder.path()); }
  /// All that there is to hear now.
  Changes heard() { return events.wait(kAWhile); }

  test::TestFolder folder;
  FolderEvents events{FolderEvents::Source::kernel};
};

TEST_F(KernelEvents, TellAFileThatIsClosedFromOneThatIsNot) {
  folder.write("whole.jpg", "whole");
  std::ofstream open(folder / "open.jpg", std::ios::binary);
  open << "a part" << std::flush;
  EXPECT_EQ(heard(),
            (Changes{{folder / "open.jpg", Change::touched}, {folder / "whole.jpg", Change::written}}));
  open.close();
  EXPECT_EQ(heard(), (Changes{{folder / "open.jpg", Change::written}}));
}

TEST_F(KernelEvents, TellWhatHappenedLastToAFile) {
  folder.write("1.jpg", "whole");
  std::ofstream again(folder / "1.jpg", std::ios::binary | std::ios::app);
  again << "and more" << std::flush;
  EXPECT_EQ(heard(), (Changes{{folder / "1.jpg", Change::touched}}));
}

TEST_F(KernelEvents, TakeAFileThatIsMovedHereForWritten) {
  const test::TestFolder elsewhere;
  fs::rename(elsewhere.write("1.part", "whole"), folder / "1.jpg");
  EXPECT_EQ(heard(), (Changes{{folder / "1.jpg", Change::written}}));
}

TEST_F(KernelEvents, SayNothingOfFoldersReadersAndWhatIsGone) {
  const fs::path file = folder.write("1.jpg", "whole");
  EXPECT_EQ(heard().size(), 1U);
  fs::create_directory(folder / "DCIM");
  EXPECT_EQ(test::bytesOf(file), "whole");
  fs::remove(file);
  EXPECT_EQ(heard(), Changes{});
}

TEST_F(KernelEvents, WakeWhoWaits) {
  const auto begin = Clock::now();
  std::thread camera([&] {
    std::this_thread::sleep_for(50ms);
    folder.write("1.jpg", "");
  });
  Changes changes;
  while (changes.empty() && Clock::now() - begin < kSoon) changes = events.wait(kSoon);
  camera.join();
  EXPECT_EQ(changes.count(folder / "1.jpg"), 1U);
  EXPECT_LT(Clock::now() - begin, kSoon);
}

TEST_F(KernelEvents, DoNotCountAFolderTwice) {
  events.watch(folder.path());
  folder.write("1.jpg", "whole");
  EXPECT_EQ(heard(), (Changes{{folder / "1.jpg", Change::written}}));
  EXPECT_EQ(heard(), Changes{});
}

TEST_F(KernelEvents, AreHeardAgainOfAFolderThatWasAway) {
  const fs::path card = folder / "card";
  fs::create_directory(card);
  events.watch(card);
  fs::rename(card, folder / "away");
  EXPECT_EQ(heard(), Changes{});
  folder.write("away/1.jpg", "not under a name that is no longer true");
  EXPECT_EQ(heard(), Changes{});
  fs::rename(folder / "away", card);
  events.watch(card);
  folder.write("card/2.jpg", "two");
  EXPECT_EQ(heard(), (Changes{{card / "2.jpg", Change::written}}));
}

TEST_F(KernelEvents, OfAFolderThatIsNotThereAreNone) {
  events.watch(folder / "not there");
  events.watch(folder.write("file.jpg", "no folder"));
  EXPECT_EQ(heard().size(), 1U) << "of the file itself";
  EXPECT_EQ(heard(), Changes{});
}

TEST_F(KernelEvents, AreAllHeardOfManyFiles) {
  constexpr int kFiles = 2000;
  for (int i = 0; i < kFiles; ++i) folder.write(std::to_string(i) + ".jpg", "whole");
  EXPECT_EQ(heard().size(), static_cast<std::size_t>(kFiles));
}

TEST(NoEvents, AreWaitedForUntilTheTimeIsOver) {
  const test::TestFolder folder;
  FolderEvents events(FolderEvents::Source::none);
  events.watch(folder.path());
  folder.write("1.jpg", "whole");
  const auto begin = Clock::now();
  EXPECT_EQ(events.wait(50ms), Changes{});
  EXPECT_GE(Clock::now() - begin, 50ms);
}

}  // namespace
}  // namespace thermovox
