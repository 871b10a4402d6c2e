#!/bin/bash
# Starts ROS, the driver and the node, as on the UAV's computer. Ends as the node does, whose exit
# code says whether it kept its distance.
cd "$(dirname "$0")" || exit 2
port=$((11311 + $$ % 1000))  # so that several can run on one machine
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1
ROS_LOG_DIR=$(mktemp -d) && export ROS_LOG_DIR

roscore -p $port &
./driver.py &
./wall_keeper.py
result=$?

rm -r "$ROS_LOG_DIR"
exit $result  # with this script, the flight and all of its processes end
