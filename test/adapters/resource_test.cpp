// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A robot description may open only regular files in packages and in the configured root folders.
#include "hgrid_proximity/adapters/resource.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "test/adapters/temporary_folder.h"
#include "test/support/few_files.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

namespace fs = std::filesystem;

/// Creates a package `p` in <folder>/p, a root folder <folder>/root, and files outside of both.
class Resource : public ::testing::Test {
 protected:
  Resource() {
    folder_.write("p/meshes/a.stl", "inside");
    folder_.write("root/b.stl", "rooted");
    folder_.write("outside.stl", "outside");
    folder_.write("p_sibling/c.stl", "sibling");
    policy_.package_path = [this](const std::string& name) { return name == "p" ? folder_ / "p" : std::string(); };
    policy_.file_roots = {folder_ / "root"};
  }

  std::string textOf(const std::string& uri) {
    const OpenResource file = openResource(uri, policy_);
    std::string bytes(file.bytes() + 1, '\0');
    const ssize_t count = ::read(file.fd(), &bytes[0], bytes.size());
    bytes.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return bytes;
  }
  Code refusal(const std::string& uri, std::string* sentence = nullptr) {
    return refusalOf([&] { openResource(uri, policy_); }, sentence);
  }

  TemporaryFolder folder_;
  ResourcePolicy policy_;
};

TEST_F(Resource, FilesOfPackagesAndRootsAreOpen) {
  EXPECT_EQ(textOf("package://p/meshes/a.stl"), "inside");
  EXPECT_EQ(textOf("file://" + folder_ / "root/b.stl"), "rooted");
  const OpenResource file = openResource("package://p/meshes/../meshes/./a.stl", policy_);
  EXPECT_EQ(file.path(), folder_ / "p/meshes/a.stl");
  EXPECT_EQ(file.bytes(), 6u);
}

TEST_F(Resource, LinksAreFollowedBeforeComparing) {
  fs::create_symlink(folder_ / "p", folder_ / "link_to_p");
  fs::create_symlink(folder_ / "root", folder_ / "link_to_root");
  fs::create_symlink("a.stl", folder_ / "p/meshes/same.stl");
  fs::create_symlink(folder_ / "root/b.stl", folder_ / "p/rooted.stl");
  policy_.package_path = [this](const std::string&) { return folder_ / "link_to_p"; };
  policy_.file_roots = {folder_ / "link_to_root"};
  EXPECT_EQ(textOf("package://p/meshes/a.stl"), "inside");
  EXPECT_EQ(textOf("package://p/meshes/same.stl"), "inside");
  EXPECT_EQ(textOf("file://" + folder_ / "link_to_root/b.stl"), "rooted");
  EXPECT_EQ(textOf("file://" + folder_ / "root/b.stl"), "rooted");
  EXPECT_EQ(textOf("package://p/rooted.stl"), "rooted") << "a symbolic link in a package may lead to a root";
}

TEST_F(Resource, NothingAboveAPackageIsOpen) {
  for (const char* path : {"../outside.stl", "../../../../../../../../etc/passwd", "meshes/../../outside.stl",
                           "../p_sibling/c.stl", "/etc/passwd", "..//outside.stl"}) {
    std::string sentence;
    const Code code = refusal(std::string("package://p/") + path, &sentence);
    EXPECT_TRUE(code == Code::resource_denied || (path[0] == '/' && code == Code::resource_missing)) << path;
    EXPECT_TRUE(says(sentence, path));
  }
  EXPECT_NE(refusal("package://../outside.stl"), Code::ok) << "'..' is not a package";
}

TEST_F(Resource, NoSymbolicLinkLeadsOut) {
  fs::create_symlink(folder_ / "outside.stl", folder_ / "p/meshes/file.stl");
  fs::create_symlink("../../outside.stl", folder_ / "p/meshes/relative.stl");
  fs::create_symlink(folder_.path(), folder_ / "p/meshes/folder");
  fs::create_symlink(folder_ / "outside.stl", folder_ / "root/file.stl");
  fs::create_symlink("loop.stl", folder_ / "p/meshes/loop.stl");
  for (const char* path : {"file.stl", "relative.stl", "folder/outside.stl"}) {
    EXPECT_EQ(refusal(std::string("package://p/meshes/") + path), Code::resource_denied) << path;
  }
  EXPECT_EQ(refusal("file://" + folder_ / "root/file.stl"), Code::resource_denied);
  EXPECT_NE(refusal("package://p/meshes/loop.stl"), Code::ok);
}

TEST_F(Resource, FilesOutsideTheRootsAreDenied) {
  fs::create_directories(folder_ / "root_too");
  folder_.write("root_too/d.stl", "outside of the root");
  for (const std::string& path : {std::string("/etc/passwd"), folder_ / "outside.stl", folder_ / "root/../outside.stl",
                                  folder_ / "root_too/d.stl"}) {
    std::string sentence;
    EXPECT_EQ(refusal("file://" + path, &sentence), Code::resource_denied) << path;
    EXPECT_TRUE(says(sentence, path));
  }
  EXPECT_EQ(refusal("file://" + folder_ / "root"), Code::resource_denied);
  policy_.file_roots.clear();
  EXPECT_EQ(refusal("file://" + folder_ / "root/b.stl"), Code::resource_denied);
}

TEST_F(Resource, WithoutASchemeNothingIsOpen) {
  for (const std::string& uri :
       {std::string(), std::string("/etc/passwd"), std::string("etc"), folder_ / "root/b.stl", std::string("file:"),
        std::string("file://"), std::string("package://"), std::string("://")}) {
    EXPECT_NE(refusal(uri), Code::ok) << uri;
  }
}

TEST_F(Resource, NoSocketIsEverOpened) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  ASSERT_GE(listener, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(listener, 16), 0);
  ASSERT_EQ(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string rest = "://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/a.stl";

  MeshPolicy policy = meshPolicy();
  policy.resources = policy_;
  MeshLoader loader(policy);
  for (const char* scheme : {"http", "https", "ftp", "gopher", "dict", "smb", "HTTP", "file", "FILE", "ws", "scp"}) {
    const std::string uri = scheme + rest;
    EXPECT_EQ(refusal(uri), Code::resource_denied) << uri;
    EXPECT_EQ(refusalOf([&] { loader.load(uri, {1, 1, 1}); }), Code::resource_denied) << uri;
  }
  pollfd waiting{listener, POLLIN, 0};
  EXPECT_EQ(poll(&waiting, 1, 0), 0) << "the loader opened a connection";  // connect() is synchronous
  close(listener);
}

TEST_F(Resource, OnlyRegularFilesAreOpen) {
  ASSERT_EQ(mkfifo((folder_ / "root/fifo.stl").c_str(), 0600), 0);
  fs::create_directory(folder_ / "root/folder.stl");
  fs::create_symlink("/dev/zero", folder_ / "root/zero.stl");
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = folder_ / "root/socket.stl";
  ASSERT_LT(name.size(), sizeof address.sun_path);
  name.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  for (const char* file : {"fifo.stl", "folder.stl", "zero.stl", "socket.stl"}) {
    EXPECT_EQ(refusal("file://" + folder_ / "root/" + file), Code::resource_denied) << file;
  }
  policy_.file_roots.push_back("/dev");
  EXPECT_EQ(refusal("file:///dev/zero"), Code::resource_denied);
  policy_.file_roots.push_back("/");
  EXPECT_EQ(refusal("file:///dev/zero"), Code::resource_denied);
  EXPECT_EQ(refusal("file://" + folder_ / "root/zero.stl"), Code::resource_denied);
  close(listener);
}

TEST_F(Resource, MissingFilesAreReported) {
  for (const std::string& uri :
       {std::string("package://p/meshes/gone.stl"), std::string("package://q/a.stl"),
        "file://" + folder_ / "root/gone.stl", std::string("package://p/meshes/a.stl/b.stl")}) {
    std::string sentence;
    EXPECT_EQ(refusal(uri, &sentence), Code::resource_missing) << uri;
    EXPECT_TRUE(says(sentence, uri));
  }
  policy_.package_path = nullptr;
  EXPECT_EQ(refusal("package://p/meshes/a.stl"), Code::resource_missing) << "without package_path no package is known";
}

/// Claim: if the process may open no further file, the refusal says so. It does not say that the file is missing.
TEST_F(Resource, TheLimitOfOpenFilesIsReportedAsALimit) {
  if (!canLimitFiles()) GTEST_SKIP() << "the sanitizer needs files of its own";
  for (const int more : {0, 1}) {  // the file is opened twice: first without its content, then with it
    std::string sentence;
    const FewFiles few(more);
    EXPECT_EQ(refusal("package://p/meshes/a.stl", &sentence), Code::limit) << more;
    EXPECT_TRUE(says(sentence, "this process may open no further file (Too many open files); raise its limit"));
  }
  policy_.package_path = [](const std::string&) { return std::string(); };  // as if no folder could be searched
  std::string sentence;
  const FewFiles few(0);
  EXPECT_EQ(refusal("package://p/meshes/a.stl", &sentence), Code::limit) << sentence;
}

TEST_F(Resource, OddPathsAreRefusedAndPrintable) {
  const std::vector<std::string> paths = {"%2e%2e/outside.stl", std::string("meshes/a.stl\0.stl", 17),
                                          std::string("../outside.stl\0meshes/a.stl", 27), std::string(5000, 'x'),
                                          "meshes/\n\x1b[31m.stl"};
  for (const std::string& path : paths) {
    std::string sentence;
    EXPECT_NE(refusal("package://p/" + path, &sentence), Code::ok);
    EXPECT_LT(sentence.size(), 1000u);
    for (const char c : sentence) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
  }
}

TEST_F(Resource, BytesAreLimited) {
  policy_.max_bytes = 6;
  EXPECT_EQ(textOf("package://p/meshes/a.stl"), "inside");
  policy_.max_bytes = 5;
  std::string sentence;
  EXPECT_EQ(refusal("package://p/meshes/a.stl", &sentence), Code::limit);
  for (const char* word : {"a.stl", "6", "5"}) EXPECT_TRUE(says(sentence, word));

  policy_.max_bytes = ResourcePolicy().max_bytes;
  EXPECT_EQ(policy_.max_bytes, 64u << 20);
  folder_.write("root/huge.stl", "");
  fs::resize_file(folder_ / "root/huge.stl", (64u << 20) + 1);
  EXPECT_EQ(refusal("file://" + folder_ / "root/huge.stl"), Code::limit);
}

TEST_F(Resource, AFileIsClosedOnceByItsLastOwner) {
  int fd = -1;
  {
    OpenResource first = openResource("package://p/meshes/a.stl", policy_);
    fd = first.fd();
    const OpenResource second = std::move(first);
    EXPECT_EQ(second.fd(), fd);
    EXPECT_GE(fcntl(fd, F_GETFD), 0);
  }
  EXPECT_EQ(fcntl(fd, F_GETFD), -1);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
