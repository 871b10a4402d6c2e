#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <sys/types.h>

#include <tether/client/exec/group_page.h>
#include <tether/link/messages.h>

namespace tether::as_is {

/// One of several processes of a program that share one execution time: its side of the page, and
/// the connection on which tether-exec tells it what it waits for. Thread-safe.
class GroupMember {
 public:
  /// The folder of tether-exec's socket has the page. None, with a line: it cannot be mapped.
  static std::unique_ptr<GroupMember> of_environment();

  /// The same in a child that was forked, which is a process of its own.
  static std::unique_ptr<GroupMember> of_child(const GroupMember& parent);

  client::GroupPage& page() const { return *page_; }
  client::GroupPage::Process& process() const { return *process_; }
  const std::string& socket() const { return socket_; }

  /// What comes from now on goes to `handle`, on a thread of its own; the first call counts.
  using Handle = std::function<void(client::GroupEvent, const link::Reply&)>;
  void listen(const Handle& handle);

 private:
  GroupMember(std::shared_ptr<client::GroupPage> page, std::string socket);
  void hear(const Handle& handle) const;

  std::shared_ptr<client::GroupPage> page_;  // a child that was forked has the same
  std::string socket_;
  client::GroupPage::Process* process_;
  std::once_flag listens_;
};

}  // namespace tether::as_is
