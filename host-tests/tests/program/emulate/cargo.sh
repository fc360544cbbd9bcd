#!/bin/sh
# A cargo whose target folder is FOLDER, and whose builds fail with the words SAYS.
if [ "$1" = metadata ]; then
    echo "{\"target_directory\": \"$FOLDER\"}"
else
    echo "$SAYS" >&2
    exit 101
fi
