#pragma once

namespace plumb::app {

inline constexpr int kOk = 0;
inline constexpr int kCheckFailed = 1;    ///< a check failed, or an engine could not continue
inline constexpr int kUsage = 2;          ///< usage or bad input
inline constexpr int kNothingFree = 3;    ///< `work --next`: every unit is done, given up, or another's
inline constexpr int kNoData = 4;         ///< the measurements, which are not part of plumb, are missing
inline constexpr int kInterrupted = 130;  ///< by the user; finished work is kept

}  // namespace plumb::app
