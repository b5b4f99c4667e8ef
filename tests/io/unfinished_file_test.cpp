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

/// As this host names it.
std::string nameWith(const std::string& numbers) {
  const TestFolder folder;
  const UnfinishedFile file = beside(folder);
  const std::string name = file.path().filename();
  return name.substr(0, name.rfind('-', name.rfind('-') - 1)) + "-" + numbers + ".unfinished";
}

TEST(UnfinishedFile, OfAKilledProcessIsRemovedWhoeverHasItsNumberNow) {
  const TestFolder folder;
  folder.write(nameWith("1-0"), "of a process whose number another one has now");
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
  const fs::path held = folder.write(nameWith("999999999-0"), "of a number that does not live here");
  const int descriptor = ::open(held.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(descriptor, LOCK_EX), 0);
  (void)beside(folder);
  EXPECT_TRUE(fs::exists(held));
  ::close(descriptor);
  (void)beside(folder);
  EXPECT_FALSE(fs::exists(held));
}

// Where the locks of other hosts are not seen; and where its maker could not lock it.
TEST(UnfinishedFile, OfAnotherHostOrWithoutALockGoesAfterAnHourWithoutAChange) {
  const TestFolder folder;
  const std::string host = nameWith("1-0").substr(std::string("plant.tvx.").size());
  for (const std::string& name : {std::string("plant.tvx.other-host-1-0.unfinished"), "plant.tvx.@" + host}) {
    const fs::path file = folder.write(name, "of nobody who is seen here");
    const auto age = [&](std::chrono::minutes by) {
      fs::last_write_time(file, fs::file_time_type::clock::now() - by);
      (void)beside(folder);
      return fs::exists(file);
    };
    EXPECT_TRUE(age(std::chrono::minutes(58))) << name;
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    ASSERT_EQ(::flock(descriptor, LOCK_EX), 0);
    EXPECT_TRUE(age(std::chrono::minutes(62))) << name;
    ::close(descriptor);
    EXPECT_FALSE(age(std::chrono::minutes(62))) << name;
  }
}

TEST(UnfinishedFile, OfOtherNamesStay) {
  const TestFolder folder;
  const std::string mine = nameWith("1-0");
  const std::vector<std::string> names{"other.tvx" + mine.substr(9), "plant.tvx.mine.unfinished",
                                       "plant.tvx.unfinished", mine + ".txt"};
  for (const std::string& name : names) folder.write(name, "mine");
  fs::create_directory(folder / mine);
  fs::create_symlink(folder / names[0], folder / nameWith("1-1"));
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
