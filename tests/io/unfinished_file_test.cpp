#include "io/unfinished_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>
#include <thread>
#include <vector>

#include "projection/error.hpp"
#include "tests/io/stations.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::namesIn;
using test::TestFolder;
using testing::HasSubstr;
using testing::IsEmpty;

UnfinishedFile beside(const TestFolder& folder) {
  return {folder / "plant.tvx", "plant.tvx"};
}

TEST(UnfinishedFile, IsGoneWithItsObjectUnlessItWasKept) {
  const TestFolder folder;
  {
    UnfinishedFile kept = beside(folder);
    const UnfinishedFile dropped = beside(folder);
    EXPECT_EQ(namesIn(folder.path()).size(), 2U);
    fs::rename(kept.path(), folder / "plant.tvx");
    kept.keep();
  }
  EXPECT_THAT(namesIn(folder.path()), testing::ElementsAre("plant.tvx"));
}

TEST(UnfinishedFile, OfAKilledProcessIsRemovedWhoeverHasItsNumberNow) {
  const TestFolder folder;
  folder.write("plant.tvx.1-0.unfinished", "of a process on another host, whose number lives here");
  const pid_t child = fork();
  if (child == 0) {
    const UnfinishedFile file = beside(folder);
    _exit(0);  // without its destructor, as if killed
  }
  waitpid(child, nullptr, 0);
  EXPECT_EQ(namesIn(folder.path()).size(), 1U);  // the child has removed the other one
  (void)beside(folder);
  EXPECT_THAT(namesIn(folder.path()), IsEmpty());
}

TEST(UnfinishedFile, ThatAnybodyHoldsStays) {
  const TestFolder folder;
  const fs::path held =
      folder.write("plant.tvx.999999999-0.unfinished", "of a number that does not live here");
  const int descriptor = ::open(held.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(descriptor, LOCK_EX), 0);
  (void)beside(folder);
  EXPECT_TRUE(fs::exists(held));
  ::close(descriptor);
  (void)beside(folder);
  EXPECT_FALSE(fs::exists(held));
}

TEST(UnfinishedFile, OfOtherNamesStay) {
  const TestFolder folder;
  const std::vector<std::string> names{"other.tvx.1-0.unfinished", "plant.tvx.mine.unfinished",
                                       "plant.tvx.unfinished", "plant.tvx.1-0.unfinished.txt"};
  for (const std::string& name : names) folder.write(name, "mine");
  fs::create_directory(folder / "plant.tvx.1-0.unfinished");
  fs::create_symlink(folder / names[0], folder / "plant.tvx.1-1.unfinished");
  (void)beside(folder);
  EXPECT_EQ(namesIn(folder.path()).size(), names.size() + 2);
}

TEST(UnfinishedFile, OfManyWritersAtOnceIsNeverTakenForLeft) {
  const TestFolder folder;
  std::vector<pid_t> writers;
  for (int i = 0; i < 6; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      bool there = true;
      for (int round = 0; round < 200; ++round) {
        const UnfinishedFile file = beside(folder);
        std::this_thread::yield();
        there = there && fs::exists(file.path());
      }
      _exit(there ? 0 : 1);
    }
    writers.push_back(child);
  }
  for (const pid_t writer : writers) {
    int status = 0;
    waitpid(writer, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_THAT(namesIn(folder.path()), IsEmpty());
}

TEST(UnfinishedFile, ThatCannotBeCreatedIsAnError) {
  const TestFolder folder;
  EXPECT_THAT(test::messageOf<DataError>(
                  [&] { const UnfinishedFile file(folder / "no" / "plant.tvx", "plant.tvx"); }),
              HasSubstr("plant.tvx: cannot be written, nothing can be created in its folder"));
}

}  // namespace
}  // namespace thermovox
