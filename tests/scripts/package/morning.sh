#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The computer is switched on, without a network, its root read-only under a layer in memory. Later its camera is late, and its disk full.
source /in_container.sh

fact start_to_light_s "$(seconds_until_light)"
fact light "$(lives)"
fact interfaces "$(ls /sys/class/net)"

sed -i '0,/"twin"/s//"v4l2"/' /etc/handcast/show.toml
systemctl restart --no-block handcast@show
until as_user status --rig show | grep "no camera is attached"; do sleep 0.2; done
more_than 0
fact light_of_the_tracker_alone "$(lives)"
as_user swap camera twin && fact camera_that_came_late "$(lives)"
sed -i '0,/"v4l2"/s//"twin"/' /etc/handcast/show.toml

systemctl stop handcast@show
for folder in /var/lib/handcast /var/log/handcast; do
  mount -t tmpfs -o size=64k,mode=755,uid="$(id -u handcast)" full "$folder"
done
systemctl start handcast@show
more_than 0
for folder in /var/lib/handcast /var/log/handcast; do head -c 1M /dev/zero >$folder/filled; done
fact light_with_a_full_disk "$(lives)"
pkill -KILL -u handcast handcast-proj
more_than "$(frames)"
fact light_after_a_death_with_a_full_disk "$(lives)"
systemctl restart handcast@show
more_than 0
fact light_of_a_start_with_a_full_disk "$(lives)"
fact done yes
systemctl poweroff
