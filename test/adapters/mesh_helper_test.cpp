// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The mesh loader reads files in a helper process. Whatever the helper does, the caller gets a refusal in time, and no
// child process and no open file remains. The next file can be read. HGRID_FAKE_MESH_READER is a helper that
// misbehaves.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>

#include "src/adapters/mesh/mesh_stream.h"
#include "test/adapters/temporary_folder.h"
#include "test/support/few_files.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

extern char** environ;

namespace hgrid {
namespace test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCorner = "package://hgrid_test/meshes/corner.stl";

std::ptrdiff_t openFiles() { return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()); }

/// Returns the largest address space [bytes] that this process has ever had.
std::size_t peakMemory() {
  const std::string status = fileText("/proc/self/status");
  return std::strtoull(status.c_str() + status.find("VmPeak:") + 7, nullptr, 10) << 10;
}

class MeshHelper : public ::testing::Test {
 protected:
  /// Reads a valid file with a fake helper. Stores the error sentence in sentence_.
  /// @param behavior  name of the fake helper, which decides what it does
  /// @param ends      whether the helper ends by itself; if not, its timeout is 300 ms
  /// @returns the code of the refusal
  Code refusalWith(const std::string& behavior, bool ends = true) {
    const std::string reader = folder_ / behavior;
    fs::copy_file(HGRID_FAKE_MESH_READER, reader, fs::copy_options::skip_existing);
    MeshPolicy policy = meshPolicy();
    policy.reader = reader;
    policy.timeout = std::chrono::milliseconds(ends ? 60000 : 300);
    MeshLoader loader(policy);
    return refusalOf([&] { mesh_ = loader.load(kCorner, {1, 1, 1}); }, &sentence_);
  }
  /// Reads a valid file with a fake helper that writes `output`. @returns the code of the refusal
  Code refusalWhenToldBy(const std::string& output) {
    folder_.write("replay.out", output);
    return refusalWith("replay");
  }
  /// Returns the output of the real helper for the file that refusalWith() reads.
  static std::string trueOutput() { return outputOfHelperFor(ownData() + "/meshes/corner.stl"); }
  /// Returns the output of the real helper whose standard input is this file.
  static std::string outputOfHelperFor(const std::string& file);

  void TearDown() override {
    EXPECT_TRUE(waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD) << "a child process is left over";
    EXPECT_EQ(openFiles(), open_before_);
    MeshLoader loader(meshPolicy());
    EXPECT_EQ(loader.load(kCorner, {1, 1, 1})->triangles.size(), 4u);
  }

  TemporaryFolder folder_;
  std::ptrdiff_t open_before_ = openFiles();
  std::string sentence_;
  std::shared_ptr<const TriangleMesh> mesh_;
};

std::string MeshHelper::outputOfHelperFor(const std::string& file) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("cannot create a pipe");
  posix_spawn_file_actions_addopen(&actions, 0, file.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  const char* arguments[] = {HGRID_MESH_READER, "stl", "1000000", "536870912", "6", nullptr};
  pid_t child = 0;
  const int failure = posix_spawn(&child, arguments[0], &actions, nullptr, const_cast<char**>(arguments), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string output;
  char buffer[4096];
  for (ssize_t count; (count = read(ends[0], buffer, sizeof buffer)) > 0;) {
    output.append(buffer, static_cast<std::size_t>(count));
  }
  close(ends[0]);
  if (failure != 0 || waitpid(child, nullptr, 0) != child) throw std::runtime_error("cannot start the helper");
  return output;
}

TEST_F(MeshHelper, ACrashIsRefused) {
  for (const char* behavior : {"crash", "abort", "fail", "silent"}) {
    EXPECT_EQ(refusalWith(behavior), Code::truncated) << behavior;
    EXPECT_TRUE(says(sentence_, "corner.stl"));
  }
}

/// Claim: however few further files the process may open, for the mesh or for the pipe to the helper, the refusal says
/// that a limit is reached.
TEST_F(MeshHelper, WithoutAPipeOrAFileIsALimit) {
  if (!canLimitFiles()) GTEST_SKIP() << "the sanitizer needs files of its own";
  ASSERT_EQ(refusalWith("crash"), Code::truncated) << "the fake helper is not there";
  bool pipe = false;
  for (int more = 0; more < 8; ++more) {
    Code code = Code::ok;
    {
      const FewFiles few(more);
      code = refusalWith("crash");
    }
    EXPECT_TRUE(code == Code::limit || code == Code::truncated) << more << " " << sentence_;
    pipe = pipe || sentence_.find("cannot create a pipe") != std::string::npos;
  }
  EXPECT_TRUE(pipe) << "no refusal was about a pipe";
}

TEST_F(MeshHelper, AHangIsRefusedWhenItsTimeIsUp) {
  for (const char* behavior : {"hang", "hang_deaf"}) {
    EXPECT_EQ(refusalWith(behavior, false), Code::budget) << behavior;
    for (const char* word : {"corner.stl", "0.3"}) EXPECT_TRUE(says(sentence_, word));
  }
  EXPECT_NE(refusalWith("hang_mute", false), Code::ok);
  folder_.write("drip.out", trueOutput());
  EXPECT_EQ(refusalWith("drip", false), Code::budget) << "the timeout is for the whole file, not for each byte";
}

TEST_F(MeshHelper, ManyHangsTogetherEndAtTheLimitForAllFiles) {
  const std::string reader = folder_ / "hang";
  fs::copy_file(HGRID_FAKE_MESH_READER, reader);
  MeshPolicy policy = meshPolicy();
  policy.reader = reader;
  policy.resources.file_roots = {folder_.path()};
  policy.timeout = std::chrono::milliseconds(100);
  policy.total = std::chrono::milliseconds(250);
  MeshLoader loader(policy);
  int asked = 0;  // files for which the helper was started
  for (int i = 0; i < 20; ++i) {
    const std::string uri = "file://" + folder_.write(std::to_string(i) + ".stl", "x");
    EXPECT_EQ(refusalOf([&] { loader.load(uri, {1, 1, 1}); }, &sentence_), Code::budget);
    EXPECT_TRUE(says(sentence_, "/" + std::to_string(i) + ".stl"));
    asked += says(sentence_, "took longer") ? 1 : 0;
  }
  EXPECT_GE(asked, 1);
  EXPECT_LE(asked, 5) << "each of them takes 100 ms, apart from rounding";
  EXPECT_TRUE(says(sentence_, "it was not read, because reading the files before it took 0.25 s"));
}

TEST_F(MeshHelper, AHangEndsWhenTheReadingIsCanceled) {
  const std::string reader = folder_ / "hang";
  fs::copy_file(HGRID_FAKE_MESH_READER, reader);
  MeshPolicy policy = meshPolicy();
  policy.reader = reader;
  policy.timeout = std::chrono::hours(1);
  int asked = 0;
  policy.cancelled = [&] { return ++asked == 3; };
  MeshLoader loader(policy);
  EXPECT_EQ(refusalOf([&] { loader.load(kCorner, {1, 1, 1}); }, &sentence_), Code::busy);
  EXPECT_TRUE(says(sentence_, "was canceled"));
  EXPECT_EQ(asked, 3);
}

TEST_F(MeshHelper, GarbageIsRefused) {
  EXPECT_NE(refusalWith("flood"), Code::ok);
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    std::string bytes(static_cast<std::size_t>(random.between(1, 100000)), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.below(256));
    EXPECT_NE(refusalWhenToldBy(bytes), Code::ok) << i;
    EXPECT_TRUE(says(sentence_, "corner.stl"));
  }
  EXPECT_NE(refusalWhenToldBy("a line of text\n"), Code::ok);
  EXPECT_NE(refusalWhenToldBy(std::string(4096, '\xff')), Code::ok);
}

TEST_F(MeshHelper, HalfAMeshIsRefused) {
  const std::string whole = trueOutput();
  ASSERT_EQ(refusalWhenToldBy(whole), Code::ok) << sentence_;
  EXPECT_EQ(mesh_->triangles.size(), 4u);
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += bytes < 40 ? 1 : 7) {
    EXPECT_EQ(refusalWhenToldBy(whole.substr(0, bytes)), Code::truncated) << bytes << " of " << whole.size();
  }
}

TEST_F(MeshHelper, HugeCountsAreRefusedBeforeAllocation) {
  const std::string whole = trueOutput();
  const std::size_t before = peakMemory();
  for (const std::uint32_t count : {0xffffffffu, 0x7fffffffu, 0x08000000u, 1000001u}) {
    for (std::size_t at = 0; at < sizeof(StreamHeader); at += 4) {
      std::string lie = whole;
      std::memcpy(&lie[at], &count, 4);
      EXPECT_NE(refusalWhenToldBy(lie), Code::ok) << count << " at " << at;
      EXPECT_NE(refusalWhenToldBy(lie + std::string(5000, '\0')), Code::ok) << count << " at " << at;
    }
  }
  EXPECT_LT(peakMemory() - before, 256u << 20);
}

TEST_F(MeshHelper, OutputOfTheHelperIsCheckedAgain) {
  const std::string whole = trueOutput();
  for (int seed = 0; seed < 300; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    std::string lie = whole;
    for (int i = random.between(1, 3); i > 0; --i) {
      lie[static_cast<std::size_t>(random.below(static_cast<int>(lie.size())))] = static_cast<char>(random.below(256));
    }
    if (refusalWhenToldBy(lie) != Code::ok) continue;
    for (const Eigen::Vector3d& v : mesh_->vertices) EXPECT_LE(v.cwiseAbs().maxCoeff(), ShapeLimits().max_size) << seed;
    for (const auto& t : mesh_->triangles) {
      for (const std::uint32_t index : t) EXPECT_LT(index, mesh_->vertices.size()) << seed;
    }
  }
}

/// Claim: the real helper does not take an error while it reads the file for the end of the file.
TEST_F(MeshHelper, AnErrorWhileTheFileIsReadIsReported) {
  const std::string output = outputOfHelperFor(folder_ / ".");  // read() fails for a folder
  StreamHeader header;
  ASSERT_GE(output.size(), sizeof header);
  std::memcpy(&header, output.data(), sizeof header);
  EXPECT_EQ(header.kind, StreamHeader::kRefusal);
  EXPECT_EQ(static_cast<Code>(header.vertices), Code::resource_missing);
  EXPECT_EQ(output.substr(sizeof header), "it cannot be read: Is a directory");
}

TEST_F(MeshHelper, AMissingHelperIsReported) {
  MeshPolicy policy = meshPolicy();
  for (const std::string& reader :
       {folder_ / "nobody", folder_.path(), folder_.write("no_program", "text"), std::string()}) {
    policy.reader = reader;
    MeshLoader loader(policy);
    std::string sentence;
    EXPECT_NE(refusalOf([&] { loader.load(kCorner, {1, 1, 1}); }, &sentence), Code::ok) << reader;
    EXPECT_TRUE(says(sentence, "corner.stl")) << reader;
  }
}

TEST_F(MeshHelper, AFailureIsNotRemembered) {
  const std::string reader = folder_.write("reader", "");
  MeshPolicy policy = meshPolicy();
  policy.reader = reader;
  MeshLoader loader(policy);
  EXPECT_NE(refusalOf([&] { loader.load(kCorner, {1, 1, 1}); }), Code::ok);
  fs::remove(reader);
  fs::create_symlink(HGRID_MESH_READER, reader);
  EXPECT_EQ(loader.load(kCorner, {1, 1, 1})->triangles.size(), 4u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
