// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/state/state_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace test {
namespace {

/// Tests with a folder of their own.
class StateFolderTest : public ::testing::Test {
 protected:
  StateFolderTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "state_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    path_ = folder_ / "own";
  }
  ~StateFolderTest() override { std::filesystem::remove_all(folder_); }

  StateFolder open() const { return StateFolder(path_.string(), std::chrono::milliseconds(0)); }
  static StateEdit setting(const std::string& key, const std::string& text) {
    return {StateEdit::Kind::set, key, text};
  }
  void expectRefused(Code code, const std::string& part) const {
    try {
      open();
      FAIL() << "not refused";
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.code(), code);
      EXPECT_NE(std::string(refusal.what()).find(part), std::string::npos) << refusal.what();
    }
  }
  void overwrite(const std::string& file, const std::string& bytes) const { std::ofstream(path_ / file) << bytes; }

  std::filesystem::path folder_, path_;
};

TEST_F(StateFolderTest, GivesWhatWasStored) {
  {
    StateFolder folder = open();
    EXPECT_TRUE(folder.read().items.empty());
    folder.replace({{"a", "1"}, {"b", "2"}});
    folder.append({setting("a", "3"), setting("c", "4")});
    EXPECT_GT(folder.size(), folder.sizeAtFirst());
  }
  const StateFolder::Found found = open().read();
  EXPECT_EQ(found.items, (StateItems{{"a", "3"}, {"b", "2"}, {"c", "4"}}));
  EXPECT_EQ(found.damage, "");
}

TEST_F(StateFolderTest, UsesThePredecessorOfAFileThatCannotBeUsedAndSaysSo) {
  {
    StateFolder folder = open();
    folder.replace({{"a", "1"}});
    folder.append({setting("a", "2")});
    folder.replace({{"a", "3"}});
  }
  overwrite("state", "rubbish");
  const StateFolder::Found found = open().read();
  EXPECT_EQ(found.items, (StateItems{{"a", "2"}}));
  EXPECT_NE(found.damage.find("is damaged: it does not begin with"), std::string::npos) << found.damage;
  EXPECT_NE(found.damage.find("; its predecessor is used"), std::string::npos) << found.damage;
  std::filesystem::remove(path_ / "state");
  EXPECT_NE(open().read().damage.find("is missing; its predecessor is used"), std::string::npos);
}

TEST_F(StateFolderTest, LeavesAFileOfAnotherVersionAlone) {
  open();
  overwrite("state", "hgrid_proximity_state 7\nfuture");
  EXPECT_THROW(open().read(), Refusal);
  std::ifstream in(path_ / "state");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "hgrid_proximity_state 7\nfuture");
}

TEST_F(StateFolderTest, BelongsToOneProcess) {
  const StateFolder first = open();
  expectRefused(Code::conflict, "each node needs a folder of its own");
}

TEST_F(StateFolderTest, MustBelongToTheUserAlone) {
  open();
  ASSERT_EQ(chmod(path_.c_str(), 0777), 0);
  expectRefused(Code::resource_denied, "chmod go-w");
}

TEST_F(StateFolderTest, MustBeAFolderInAnExistingOne) {
  std::ofstream(path_) << "a file";
  expectRefused(Code::resource_denied, "Not a directory");
  path_ = folder_ / "missing" / "own";
  expectRefused(Code::resource_denied, "No such file or directory");
}

TEST_F(StateFolderTest, DoesNotFollowALinkInPlaceOfItsFile) {
  open();
  std::filesystem::create_symlink("/etc/hostname", path_ / "state");
  EXPECT_THROW(open().read(), Refusal);
}

TEST_F(StateFolderTest, KeepsWhatIsThereWhileTheDiskIsFull) {
  StateFolder folder = open();
  folder.replace({{"a", "1"}});
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  const rlimit small{folder.size() + 100, old_limit.rlim_max};  // acts like a disk that is full after 100 bytes
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(folder.append({setting("b", std::string(1000, 'x'))}), Refusal);
  EXPECT_THROW(folder.replace({{"c", std::string(1000, 'x')}}), Refusal);
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(folder.read().items, (StateItems{{"a", "1"}}));
  EXPECT_EQ(folder.read().damage, "");
  folder.replace({{"c", "2"}});
  folder.append({setting("d", "3")});
  EXPECT_EQ(folder.read().items, (StateItems{{"c", "2"}, {"d", "3"}}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
