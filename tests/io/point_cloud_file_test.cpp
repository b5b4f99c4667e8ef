#include "io/point_cloud_file.hpp"

#include <gmock/gmock.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <random>

#include "projection/error.hpp"
#include "tests/support/recordings.hpp"

namespace thermovox {
namespace {

using test::messageOf;
using testing::AllOf;
using testing::HasSubstr;

pcl::PointCloud<pcl::PointXYZI> randomCloud(std::size_t size) {
  std::mt19937_64 random(3);
  std::normal_distribution<float> normal(0.0F, 10.0F);
  pcl::PointCloud<pcl::PointXYZI> cloud;
  for (std::size_t i = 0; i < size; ++i) {
    cloud.push_back({normal(random), normal(random), normal(random), std::abs(normal(random))});
  }
  cloud[1].x = std::numeric_limits<float>::quiet_NaN();
  cloud.is_dense = false;
  return cloud;
}

/// PCL is the oracle: what it wrote is what is read, to the last bit (9 digits in text are enough for a
/// float).
void expectSame(const std::vector<CloudPoint>& points, const pcl::PointCloud<pcl::PointXYZI>& cloud) {
  ASSERT_EQ(points.size(), cloud.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "point " << i);
    const Eigen::Vector3f expected = cloud[i].getVector3fMap();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::isnan(expected[axis])) {
        ASSERT_TRUE(std::isnan(points[i].p_laser[axis]));
      } else {
        ASSERT_EQ(points[i].p_laser[axis], expected[axis]);
      }
    }
    ASSERT_EQ(points[i].intensity, cloud[i].intensity);
    ASSERT_EQ(points[i].time, 0.0);
  }
}

TEST(ReadCloudPoints, ReadsWhatPclWrites) {
  const test::TestFolder folder;
  auto cloud = randomCloud(500);
  pcl::PCDWriter pcd;
  pcd.writeASCII((folder / "a.pcd").string(), cloud, 9);
  pcd.writeBinary((folder / "b.pcd").string(), cloud);
  pcd.writeBinaryCompressed((folder / "c.pcd").string(), cloud);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) {
    SCOPED_TRACE(name);
    expectSame(readCloudPoints(folder / name), cloud);
  }
  cloud[1].x = 0.0F;  // PCL leaves points that are not finite out of a PLY
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  pcl::PLYWriter().writeBinary((folder / "d.ply").string(), blob, origin, orientation, false);
  pcl::PLYWriter().writeASCII((folder / "e.ply").string(), blob, origin, orientation, 9, false);
  for (const char* name : {"d.ply", "e.ply"}) {
    SCOPED_TRACE(name);
    pcl::PointCloud<pcl::PointXYZI> read_by_pcl;  // PCL rounds the text of a PLY to 6 digits
    ASSERT_EQ(pcl::io::loadPLYFile((folder / name).string(), read_by_pcl), 0);
    ASSERT_EQ(read_by_pcl.size(), cloud.size());
    expectSame(readCloudPoints(folder / name), read_by_pcl);
  }
}

constexpr std::string_view kPcd = R"(# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y normal z intensity ring time
SIZE 4 4 4 4 1 2 8
TYPE F F F F U I F
COUNT 1 1 3 1 1 1 1
WIDTH 2
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS 2
DATA ascii
1 2 0 0 1 3 200 -7 0.25
nan 5 0 0 1 6 100 7 0.5
)";

std::string with(std::string_view old_part, std::string_view new_part) {
  std::string pcd(kPcd);
  const std::size_t place = pcd.find(old_part);
  EXPECT_NE(place, std::string::npos) << old_part;
  return pcd.replace(place, old_part.size(), new_part);
}

std::string complaintAbout(const std::string& bytes) {
  testing::internal::CaptureStderr();
  std::string complaint = messageOf<DataError>([&] { static_cast<void>(parseCloudPoints(bytes, "c.pcd")); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the library never prints";
  return complaint;
}

template <typename Number>
void append(std::string& bytes, Number number, bool big_endian = false) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &number, sizeof number);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

void expectTheTwoPoints(const std::vector<CloudPoint>& points) {
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].p_laser, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(points[0].intensity, 200.0F);
  EXPECT_EQ(points[0].time, 0.25);
  EXPECT_TRUE(std::isnan(points[1].p_laser.x()));
  EXPECT_EQ(points[1].p_laser.z(), 6.0F);
  EXPECT_EQ(points[1].time, 0.5);
}

TEST(ReadCloudPoints, FindsItsFieldsAmongOthersOfAnyType) {
  expectTheTwoPoints(parseCloudPoints(kPcd, "c.pcd"));
  std::string binary = with("DATA ascii", "DATA binary");
  binary.resize(binary.find("binary") + 7);
  for (const bool second : {false, true}) {
    append(binary, second ? NAN : 1.0F);
    append(binary, second ? 5.0F : 2.0F);
    for (const float normal : {0.0F, 0.0F, 1.0F}) append(binary, normal);
    append(binary, second ? 6.0F : 3.0F);
    append(binary, static_cast<std::uint8_t>(second ? 100 : 200));
    append(binary, static_cast<std::int16_t>(second ? 7 : -7));
    append(binary, second ? 0.5 : 0.25);
  }
  expectTheTwoPoints(parseCloudPoints(binary, "c.pcd"));
}

TEST(ReadCloudPoints, ReadsPlyOfBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string ply =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\ncomment x\nelement vertex 1\nproperty double x\nproperty double y\n"
        "property double z\nproperty uchar red\nproperty float scalar_intensity\nproperty int32 time\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (const double number : {1.5, 2.5, -3.5}) append(ply, number, big);
    append(ply, std::uint8_t{9});
    append(ply, 42.0F, big);
    append(ply, std::int32_t{-2}, big);
    const auto points = parseCloudPoints(ply, "c.ply");
    ASSERT_EQ(points.size(), 1U);
    EXPECT_EQ(points[0].p_laser, Eigen::Vector3f(1.5F, 2.5F, -3.5F));
    EXPECT_EQ(points[0].intensity, 42.0F);
    EXPECT_EQ(points[0].time, -2.0);
  }
}

TEST(ReadCloudPoints, KnowsNoIntensityWhereTheCloudHasNone) {
  const auto points = parseCloudPoints(
      "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\n"
      "property float y\r\nproperty float z\r\nend_header\r\n1 2 3\r\n",
      "c.ply");
  ASSERT_EQ(points.size(), 1U);
  EXPECT_TRUE(std::isnan(points[0].intensity));
  EXPECT_EQ(points[0].time, 0.0);
}

TEST(ReadCloudPoints, TakesASweepWithoutPoints) {
  EXPECT_TRUE(parseCloudPoints("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                               "property float z\nend_header\n",
                               "c.ply")
                  .empty());
}

TEST(ReadCloudPoints, NamesTheFieldsOfACloudWithoutPositions) {
  EXPECT_THAT(complaintAbout(with(" y ", " v ")),
              AllOf(HasSubstr("c.pcd: has the fields 'x v normal z intensity ring time'"),
                    HasSubstr("expected x y z")));
}

TEST(ReadCloudPoints, RefusesHeadersThatMakeNoSense) {
  EXPECT_THAT(complaintAbout(""), HasSubstr("c.pcd: is empty"));
  EXPECT_THAT(complaintAbout("LASF"), HasSubstr("is neither a PCD nor a PLY file"));
  EXPECT_THAT(complaintAbout("# .PCD\nVERSION 0.7\nFIELDS x y z\n"), HasSubstr("ends without DATA"));
  EXPECT_THAT(complaintAbout(with("TYPE F F F F U I F\n", "")), HasSubstr("lacks FIELDS, SIZE or TYPE"));
  EXPECT_THAT(complaintAbout(with("TYPE F", "TYPE Q")),
              HasSubstr("c.pcd:5: found 'Q', expected TYPE F, I or U"));
  EXPECT_THAT(complaintAbout(with("SIZE 4", "SIZE 3")),
              HasSubstr("c.pcd:4: found '3', expected 1, 2, 4 or 8"));
  EXPECT_THAT(complaintAbout(with("SIZE 4", "SIZE 2")), HasSubstr("field 'x' is a float of 2 bytes"));
  EXPECT_THAT(complaintAbout(with("SIZE 4 4", "SIZE 4")),
              HasSubstr("c.pcd:4: found 'SIZE', expected one entry"));
  EXPECT_THAT(complaintAbout(with("POINTS 2", "POINTS 3")),
              HasSubstr("POINTS is 3, expected WIDTH x HEIGHT = 2"));
  EXPECT_THAT(complaintAbout(with("POINTS 2", "POINTS -2")),
              HasSubstr("found '-2', expected a whole number"));
  EXPECT_THAT(complaintAbout(with("DATA ascii", "DATA zip")), HasSubstr("found 'zip', expected DATA ascii"));
  EXPECT_THAT(complaintAbout("ply\nformat ascii 2.0\n"),
              HasSubstr("c.pcd:2: found 'ascii', expected format ascii"));
  EXPECT_THAT(
      complaintAbout("ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n"),
      HasSubstr("c.pcd:4: found 'list'"));
  EXPECT_THAT(complaintAbout("ply\nformat ascii 1.0\nelement vertex 1\n"),
              HasSubstr("ends without end_header"));
}

TEST(ReadCloudPoints, BelievesNoHeaderThatClaimsMoreThanTheFileHolds) {
  std::string absurd = with("WIDTH 2", "WIDTH 4611686018427387904");
  EXPECT_THAT(complaintAbout(absurd), HasSubstr("POINTS is 2"));
  absurd.replace(absurd.find("POINTS 2"), 8, "POINTS 4611686018427387904");
  EXPECT_THAT(complaintAbout(absurd), HasSubstr("c.pcd: is truncated: holds 2 points"));
  absurd.replace(absurd.find("DATA ascii"), 10, "DATA binary");
  EXPECT_THAT(complaintAbout(absurd),
              HasSubstr("is truncated: holds 1 points, expected 4611686018427387904"));
  absurd.replace(absurd.find("DATA binary"), 11, "DATA binary_compressed");
  EXPECT_THAT(complaintAbout(absurd), HasSubstr("is truncated"));
}

TEST(ReadCloudPoints, NamesTheLineOfWhatIsNoNumber) {
  EXPECT_THAT(complaintAbout(with("nan 5", "nan five")),
              HasSubstr("c.pcd:13: found 'five', expected a number"));
  EXPECT_THAT(complaintAbout(with(" 7 0.5", " 7")), HasSubstr("c.pcd:13: has 8 numbers, expected 9"));
}

TEST(ReadCloudPoints, NamesTheFileThatIsTruncated) {
  const test::TestFolder folder;
  const auto cloud = randomCloud(40);
  pcl::PCDWriter().writeBinary((folder / "b.pcd").string(), cloud);
  pcl::PCDWriter().writeBinaryCompressed((folder / "c.pcd").string(), cloud);
  pcl::PCDWriter().writeASCII((folder / "a.pcd").string(), cloud);
  pcl::PLYWriter().write((folder / "d.ply").string(), cloud, true, false);
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd", "d.ply"}) {
    const std::string whole = test::bytesOf(folder / name);
    // A text that ends within its very last number cannot be told from a whole one.
    for (std::size_t size = 0; size + 20 < whole.size(); size += 3) {
      SCOPED_TRACE(testing::Message() << name << ", " << size << " of " << whole.size() << " bytes");
      // The whole numbers of the camera that PCL writes behind the vertices are none of ours.
      if (name == std::string_view("d.ply") && size + 100 > whole.size()) break;
      EXPECT_THAT(complaintAbout(whole.substr(0, size)), HasSubstr("c.pcd"));
    }
  }
}

TEST(ReadCloudPoints, NoticesDamagedCompression) {
  const test::TestFolder folder;
  pcl::PCDWriter().writeBinaryCompressed((folder / "c.pcd").string(), randomCloud(100));
  const std::string whole = test::bytesOf(folder / "c.pcd");
  std::mt19937_64 random(9);
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged = whole;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      EXPECT_EQ(parseCloudPoints(damaged, "c.pcd").size(), 100U) << "damage in a number goes unseen";
    } catch (const DataError&) {
    }
  }
}

TEST(ReadCloudPoints, AgreesWithPclOnTheRecordings) {
  THERMOVOX_NEEDS_RECORDINGS();
  const auto jhu = *test::recordings() / "missions/jhu-board/clouds/0001.pcd";
  pcl::PointCloud<pcl::PointXYZ> oracle;
  ASSERT_EQ(pcl::io::loadPCDFile(jhu.string(), oracle), 0);
  const auto points = readCloudPoints(jhu);
  ASSERT_EQ(points.size(), oracle.size());
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(points[i].p_laser, oracle[i].getVector3fMap());

  pcl::PointCloud<pcl::PointXYZ> kitti;
  ASSERT_EQ(pcl::io::loadPLYFile((*test::recordings() / "laser/pair/source.ply").string(), kitti), 0);
  const auto scan = readCloudPoints(*test::recordings() / "laser/pair/source.ply");
  ASSERT_EQ(scan.size(), 69792U);
  for (std::size_t i = 0; i < scan.size(); ++i) ASSERT_EQ(scan[i].p_laser, kitti[i].getVector3fMap());
  EXPECT_FALSE(std::isnan(scan[0].intensity)) << "CloudCompare's scalar_intensity";

  const auto hall = readCloudPoints(*test::recordings() / "missions/hall-cloud/clouds/000001.pcd");
  ASSERT_EQ(hall.size(), 8192U);
  EXPECT_GT(hall.back().time, hall.front().time) << "each point has a time of its own";
}

}  // namespace
}  // namespace thermovox
