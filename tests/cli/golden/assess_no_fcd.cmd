"$crashpulse" assess --collisions coll.xml --vehicle car.yaml
