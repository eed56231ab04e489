$crashpulse run x.yaml --db x.db --shard 5/4
