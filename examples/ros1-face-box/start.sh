#!/bin/bash
# Starts ROS and the nodes, as on the UAV's computer. Ends as the tracker does, whose exit code says
# whether the box is in the middle of the image.
cd "$(dirname "$0")" || exit 2
port=$((11311 + $$ % 1000))  # so that several can run on one machine
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1
ROS_LOG_DIR=$(mktemp -d) && export ROS_LOG_DIR

roscore -p $port &
./camera.py &
./mavlink_bridge.py &
./tracker.py
result=$?

rm -r "$ROS_LOG_DIR"
exit $result  # with this script, the flight and all of its processes end
