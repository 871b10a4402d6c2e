#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tether::devices {

enum class FileKind { kRegular, kFolder, kCharacterDevice, kOther };

/// The system calls by which devices are reached. Each gives what the call of its name gives, or
/// −errno, so that tests can plant what no test machine's hardware does on demand.
class System {
 public:
  virtual ~System() = default;
  /// 0, and what a path leads to.
  virtual int stat(const std::string& path, FileKind& kind) = 0;
  /// A descriptor. Never waits, for instance for the other end of a pipe.
  virtual int open(const std::string& path, bool writable) = 0;
  virtual void close(int descriptor) = 0;
  /// Reads from the beginning, whatever was read before; the number of bytes.
  virtual long read_again(int descriptor, char* buffer, std::size_t size) = 0;
  virtual int ioctl(int descriptor, unsigned long request, void* argument) = 0;
  /// Names in a folder, sorted; empty if there is no such folder.
  virtual std::vector<std::string> list(const std::string& folder) = 0;
};

/// The machine's own. Stateless; safe from any thread.
System& real_system();

/// A descriptor that is closed with its owner. The system must outlive it.
class Descriptor {
 public:
  Descriptor() = default;
  Descriptor(System& system, int number) : system_(&system), number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  System& system() const { return *system_; }

 private:
  void close();

  System* system_ = nullptr;
  int number_ = -1;
};

/// "Permission denied" for EACCES.
std::string error_text(int error);

}  // namespace tether::devices
