// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A plugin for qemu-user. It counts the instructions that a program executes in each of its functions. It writes the
// counts to the file that the argument `out=` names. The program must use only one thread.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

// The parts of qemu's plugin interface that are used here, version 1 (qemu 4.2 to 8.2). Debian does not package its
// header.
extern "C" {
struct qemu_info_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
using qemu_plugin_id_t = std::uint64_t;
enum qemu_plugin_op { QEMU_PLUGIN_INLINE_ADD_U64 };
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id, void (*call)(qemu_plugin_id_t, qemu_plugin_tb*));
void qemu_plugin_register_vcpu_insn_exec_inline(qemu_plugin_insn* insn, qemu_plugin_op op, void* counter,
                                                std::uint64_t added);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*call)(qemu_plugin_id_t, void*), void* data);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb* block);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb* block, std::size_t index);
const char* qemu_plugin_insn_symbol(const qemu_plugin_insn* insn);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;
}

namespace {

std::string out;

std::map<std::string, std::uint64_t>& counts() {  // by function; qemu keeps pointers to the values
  static auto* const counts = new std::map<std::string, std::uint64_t>;
  return *counts;
}

void onTranslation(qemu_plugin_id_t, qemu_plugin_tb* block) {
  for (std::size_t i = 0; i < qemu_plugin_tb_n_insns(block); ++i) {
    qemu_plugin_insn* const insn = qemu_plugin_tb_get_insn(block, i);
    const char* const symbol = qemu_plugin_insn_symbol(insn);
    qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64, &counts()[symbol ? symbol : "?"], 1);
  }
}

void atExit(qemu_plugin_id_t, void*) {
  std::FILE* const file = std::fopen(out.c_str(), "w");
  if (file == nullptr) return;
  for (const auto& count : counts()) {
    std::fprintf(file, "%llu %s\n", static_cast<unsigned long long>(count.second), count.first.c_str());
  }
  std::fclose(file);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t*,
                                                                          int count, char** arguments) {
  for (int i = 0; i < count; ++i) {
    if (std::strncmp(arguments[i], "out=", 4) == 0) out = arguments[i] + 4;
  }
  if (out.empty()) return 1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, onTranslation);
  qemu_plugin_register_atexit_cb(id, atExit, nullptr);
  return 0;
}
