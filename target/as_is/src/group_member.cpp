#include "group_member.h"

#include "real.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>
#include <variant>

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <tether/client/exec/local_socket.h>

namespace tether::as_is {

namespace {

std::string own_name() {
  char arguments[1024];
  const int file = ::open("/proc/self/cmdline", O_RDONLY | O_CLOEXEC);
  const ssize_t size = file < 0 ? 0 : ::read(file, arguments, sizeof arguments);
  if (file >= 0) ::close(file);
  return client::process_name({arguments, static_cast<std::size_t>(std::max<ssize_t>(size, 0))});
}

}  // namespace

GroupMember::GroupMember(std::shared_ptr<client::GroupPage> page, std::string socket)
    : page_(std::move(page)), socket_(std::move(socket)), process_(page_->enter(::getpid())) {
  page_->begin_again(::getpid());
  if (process_ != nullptr) process_->call(own_name());
}

std::unique_ptr<GroupMember> GroupMember::of_environment() {
  const char* const socket = std::getenv("TETHER_EXEC");
  const std::string path = socket == nullptr ? "" : socket;
  auto page = client::map_group_page(client::group_page_beside(path));
  if (!page) {
    std::fprintf(stderr, "tether: %s\n", page.failure().message.c_str());
    return nullptr;
  }
  std::unique_ptr<GroupMember> member(new GroupMember(std::move(*page), path));
  if (member->process_ != nullptr) return member;
  std::fprintf(stderr, "tether: more than %zu processes at once\n", client::GroupPage::kProcesses);
  return nullptr;
}

std::unique_ptr<GroupMember> GroupMember::of_child(const GroupMember& parent) {
  std::unique_ptr<GroupMember> member(new GroupMember(parent.page_, parent.socket_));
  return member->process_ == nullptr ? nullptr : std::move(member);
}

void GroupMember::listen(const Handle& handle) {
  std::call_once(listens_, [&] { std::thread([this, handle] { hear(handle); }).detach(); });
}

// Until tether-exec has gone, with which the program ends.
void GroupMember::hear(const Handle& handle) const {
  const Inside inside;
  ::pthread_setname_np(::pthread_self(), link::kClientThread);
  auto line = client::connect_local(socket_);
  link::Hello hello;
  hello.sut = client::kGroupEvents;
  hello.process = static_cast<std::uint32_t>(::getpid());
  if (!line || !line->receive() || !line->send(hello)) return;
  for (;;) {
    const auto packet = line->receive();
    if (!packet || !packet->message) return;
    if (const auto* event = std::get_if<link::Reply>(&*packet->message))
      handle(static_cast<client::GroupEvent>(event->sequence), *event);
    if (!line->send(link::Progress{})) return;
  }
}

}  // namespace tether::as_is
