# SPDX-License-Identifier: BSD-3-Clause
# The steps from photos to a dataset; map.sh calls this. Each leaves a stamp with the time at which it began, so that a
# run that was killed goes on with the step that it was in. Paths of the user come through the environment, as make
# splits names at spaces.
folder := $(MAP_ROOT)/data/$(MAP_NAME)
steps := $(MAP_ROOT)/steps
QUIET ?=

# Boxes first: COLMAP finds no features in those of things that move, and a network that cannot run is found out before
# COLMAP works for minutes; so is a truth of other photos.
.PHONY: dataset
dataset: $(steps)/true $(steps)/detected $(steps)/reconstructed

# $(call step,TITLE,COMMAND)
define step
@echo '[$(MAP_NAME)] $(1)'
@touch $@.begun
@$(2)
@mv $@.begun $@
endef

$(steps)/frames: $(steps)/images.txt
	@rm -rf $(MAP_ROOT)/.frames.*
	$(call step,frames,$(BIN)/soslam-frames --images "$$MAP_IMAGES" --output $(MAP_ROOT)/frames $$MAP_FRAMES_OPTIONS \
	  $${MAP_DETECTIONS:+--detections "$$MAP_DETECTIONS"} --threads $(MAP_THREADS) $(QUIET))

# The dataset begins with the images, as links to those of the step before, and the camera where it is given. Its texts
# are copies, which may be edited.
$(steps)/dataset: $(steps)/frames $(steps)/camera.txt
	@rm -rf $(folder).new && mkdir -p $(MAP_ROOT)/data
	@cp -rl $(MAP_ROOT)/frames $(folder).new 2> /dev/null || \
	  { rm -rf $(folder).new && cp -r $(MAP_ROOT)/frames $(folder).new; }
	@cp --remove-destination $(MAP_ROOT)/frames/*.* $(folder).new
	@rm -f $(folder).new/run.json $(folder).new/timing.json $(folder).new/SHA256SUMS
	@test -z "$$MAP_CAMERA" || cp -- "$$MAP_CAMERA" $(folder).new/camera.json
	$(call step,dataset,rm -rf $(folder) && mv $(folder).new $(folder))

# The truth changes no other step.
$(steps)/true: $(steps)/dataset $(steps)/truth.txt
	@test ! -d $(MAP_ROOT)/truth || rm -rf $(MAP_ROOT)/truth $(folder)/groundtruth.txt $(folder)/objects.json
	$(call step,truth,test -z "$$MAP_TRUTH" || { \
	  $(BIN)/soslam-truth --dataset $(MAP_ROOT)/frames --truth "$$MAP_TRUTH" --output $(MAP_ROOT)/truth $(QUIET) && \
	  cp $(addprefix $(MAP_ROOT)/truth/,groundtruth.txt objects.json) $(folder); })

# COLMAP's own files stay beside the dataset: it goes on from them. A finished model is turned as the boxes are.
$(steps)/reconstructed: $(steps)/dataset $(steps)/model.txt $(steps)/detected
	$(call step,reconstruct,$(BIN)/soslam-reconstruct --dataset $(folder) --output $(MAP_ROOT)/reconstruction \
	  $${MAP_MODEL:+--model "$$MAP_MODEL"} $${MAP_CAMERA:+--calibration given} --threads $(MAP_THREADS) \
	  $$(head -n 1 $(folder)/detections.csv 2> /dev/null | grep --quiet "$$MAP_STORED" && \
	    echo --image_orientation stored) $(QUIET) && \
	  cp $(addprefix $(MAP_ROOT)/reconstruction/,camera.json odometry.txt points.h5 reconstruction.json) $(folder))

$(steps)/detected: $(steps)/dataset $(steps)/network.txt
	@mkdir -p $(MAP_ROOT)/detections
	$(call step,detect,test -z "$$MAP_NETWORK" || { \
	  $(BIN)/soslam-detect --dataset $(folder) --network "$$MAP_NETWORK" \
	  --output $(MAP_ROOT)/detections/detections.csv --turns $(MAP_ROOT)/detections/turns.json \
	  $$MAP_DETECT_OPTIONS --threads $(MAP_THREADS) $(QUIET) && \
	  cp $(addprefix $(MAP_ROOT)/detections/,detections.csv turns.json) $(folder); })
