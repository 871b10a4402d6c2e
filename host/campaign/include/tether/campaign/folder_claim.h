#pragma once

#include <filesystem>
#include <string_view>

/// Whose folder is it? A run has its folder to itself while it lasts. A campaign has its own with
/// all that is below it while it lasts, and keeps the folders of its trials: what is in them has to
/// be of one kind. Whoever is killed holds nothing any more.
namespace tether::campaign {

/// In a campaign's folder, locked by the campaign that runs there, which writes its process id. One
/// that is locked without is not a campaign's.
inline constexpr std::string_view kLockFile = ".tether-campaign.lock";

/// A file or folder that is locked until the object goes, or the process, however it ends. Not
/// inherited by programs that are started meanwhile.
class PathLock {
 public:
  /// Waits a moment for those who only look.
  /// @param path exists, or with `makes_file` is made
  /// @throws Error(kSetup) when it cannot be opened or locked.
  explicit PathLock(const std::filesystem::path& path, bool makes_file = false);
  ~PathLock();
  PathLock(const PathLock&) = delete;
  PathLock& operator=(const PathLock&) = delete;

  /// False: somebody else holds it.
  bool is_held() const { return is_held_; }
  /// Replaces what is in the file. @throws Error(kSetup) when it cannot be written.
  void write(std::string_view text) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  bool is_held_ = false;
};

/// For who is about to write there, before he makes the folder and again once it is his.
/// @throws Error(kUsage) when the folder lies in the one of a running campaign that did not start
///   this process, or is that of a trial of any other campaign; Error(kSetup) when that cannot be
///   found out.
void require_no_campaign(const std::filesystem::path& folder);

/// For a campaign, which may remove whatever is below its folder. Those who are just being killed
/// with an earlier campaign are waited for.
/// @throws Error(kUsage) when somebody writes there; Error(kSetup) when that cannot be found out.
void require_nobody_in(const std::filesystem::path& folder);

}  // namespace tether::campaign
