#include "apps/usable_memory.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

namespace fs = std::filesystem;
using test::TestFolder;

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

TEST(UsableMemory, IsTheLeastThatTheControlGroupsLeave) {
  const TestFolder folder;
  const fs::path root = folder / "groups", list = folder / "cgroup";
  fs::create_directories(root / "jobs" / "one");
  fs::create_directories(root / "memory" / "box");
  EXPECT_EQ(groupMemory(list, root), kNone);  // no such list
  folder.write("cgroup", "0::/jobs/one\n");
  EXPECT_EQ(groupMemory(list, root), kNone);
  folder.write("groups/jobs/one/memory.max", "max\n");
  EXPECT_EQ(groupMemory(list, root), kNone);
  folder.write("groups/jobs/memory.max", "3000000000\n");
  EXPECT_EQ(groupMemory(list, root), 3'000'000'000U);
  folder.write("groups/jobs/one/memory.max", "2000000000\n");
  EXPECT_EQ(groupMemory(list, root), 2'000'000'000U);
  folder.write("cgroup", "3:cpu,cpuacct:/other\n2:blkio,memory:/box\n1:name=systemd:/\n");
  folder.write("groups/memory/box/memory.limit_in_bytes", "1000000000\n");
  EXPECT_EQ(groupMemory(list, root), 1'000'000'000U);
}

TEST(UsableMemory, OfAContainerThatKnowsItsGroupByTheHostsNameIsThatOfTheRoot) {
  const TestFolder folder;
  folder.write("cgroup", "0::/../docker/4711\n");
  folder.write("memory.max", "5000000000\n");
  EXPECT_EQ(groupMemory(folder / "cgroup", folder.path()), 5'000'000'000U);
}

TEST(UsableMemory, OfThisProcessIsSome) {
  EXPECT_GT(usableMemory(), 1'000'000U);
}

}  // namespace
}  // namespace thermovox
