colour-scale 1
20 0 1 0 0.5 green
10 0 0 0 0
