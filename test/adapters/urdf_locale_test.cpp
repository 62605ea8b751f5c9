// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The reader reads numbers with a decimal point, even if the locale of the process has a decimal comma.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>

#include <clocale>
#include <cstring>
#include <locale>

#include "test/adapters/temporary_folder.h"
#include "test/support/robots.h"

extern char** environ;

/// Returns the leaks that the leak sanitizer must ignore. glibc does not free memory that it allocates for LOCPATH.
extern "C" const char* __lsan_default_suppressions() { return "leak:argz_add_sep"; }

namespace hgrid {
namespace test {
namespace {

/// Compiles the locale de_DE.UTF-8 into a folder. @returns whether this succeeded
bool compileLocale(const std::string& folder) {
  const std::string target = folder + "/de_DE.UTF-8";
  const char* arguments[] = {"localedef", "--no-archive", "-i", "de_DE", "-f", "UTF-8", target.c_str(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, "localedef", nullptr, nullptr, const_cast<char**>(arguments), environ) != 0) return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) <= 1;  // 1: with warnings
}

/// While this object exists, the locale has a decimal comma, in the process, its C++ streams and its children.
class DecimalComma {
 public:
  DecimalComma() {
    if (compileLocale(folder_.path()) && speaks("de_DE.UTF-8", folder_.path().c_str())) return;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "es_ES.UTF-8", "ru_RU.UTF-8", "de_DE"}) {
      if (speaks(name, nullptr)) return;
    }
  }
  ~DecimalComma() {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
    unsetenv("LC_ALL");
    unsetenv("LOCPATH");
  }
  bool isSet() const { return is_set_; }

 private:
  bool speaks(const char* name, const char* folder) {
    if (folder)
      setenv("LOCPATH", folder, 1);
    else
      unsetenv("LOCPATH");
    try {
      std::locale::global(std::locale(name));
    } catch (const std::runtime_error&) {
      return false;
    }
    if (!std::setlocale(LC_ALL, name) || std::strcmp(std::localeconv()->decimal_point, ",") != 0) return false;
    setenv("LC_ALL", name, 1);
    return is_set_ = true;
  }
  TemporaryFolder folder_;
  bool is_set_ = false;
};

void expectSame(const RobotModel& a, const RobotModel& b) {
  ASSERT_EQ(a.links.size(), b.links.size());
  for (std::size_t i = 0; i < a.links.size(); ++i) {
    const RobotLink &p = a.links[i], &q = b.links[i];
    SCOPED_TRACE(p.name);
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.parent_from_joint.matrix(), q.parent_from_joint.matrix());
    EXPECT_EQ(p.axis, q.axis);
    EXPECT_EQ(p.lower, q.lower);
    EXPECT_EQ(p.upper, q.upper);
    EXPECT_EQ(p.max_velocity, q.max_velocity);
    EXPECT_EQ(p.unreadable.size(), q.unreadable.size());
    ASSERT_EQ(p.shapes.size(), q.shapes.size());
    for (std::size_t k = 0; k < p.shapes.size(); ++k) {
      EXPECT_EQ(p.shapes[k].body_from_shape.matrix(), q.shapes[k].body_from_shape.matrix());
      EXPECT_EQ(p.shapes[k].shape.dimensions(), q.shapes[k].shape.dimensions());
      EXPECT_EQ(p.shapes[k].scale, q.shapes[k].scale);
      if (p.shapes[k].shape.mesh()) {
        EXPECT_EQ(p.shapes[k].shape.mesh()->vertices, q.shapes[k].shape.mesh()->vertices);
      }
    }
  }
}

TEST(UrdfLocale, ADecimalCommaChangesNothing) {
  const std::string text = fileText(ownData() + "/robots/traits.urdf");
  MeshLoader before(meshPolicy());
  const RobotModel with_point = readWith(before, text);

  const DecimalComma comma;
  if (!comma.isSet()) GTEST_SKIP() << "there is no locale with a decimal comma, and localedef could not create one";
  ASSERT_EQ(std::strtod("1,5", nullptr), 1.5) << "the C library must read a decimal comma now";
  MeshLoader during(meshPolicy());
  expectSame(with_point, readWith(during, text));

  const std::string comma_radius =
      "<robot name=\"r\"><link name=\"a\"><collision><geometry><sphere "
      "radius=\"1,5\"/></geometry></collision></link></robot>";
  const RobotModel refused = readWith(during, comma_radius);
  EXPECT_EQ(refused.links.at(0).unreadable.size(), 1u) << "1,5 is not a number in a URDF, whatever the locale";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
