"""Package hexapod_bringup, as colcon and ament install it."""

from glob import glob

from setuptools import find_packages, setup

NAME = 'hexapod_bringup'

setup(
    name=NAME,
    version='0.1.0',
    description='Launch files, configuration and the composed worker of the hexapod graph.',
    license='Apache-2.0',
    maintainer='Hexapod team',
    maintainer_email='team@hexapod.invalid',
    packages=find_packages(exclude=['test']),
    package_data={f'{NAME}.watching': ['page.html']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/launch', glob('launch/*')),
        (f'share/{NAME}/config', glob('config/*')),
        (f'share/{NAME}/agents', glob('agents/*')),
        (f'share/{NAME}/urdf', glob('urdf/*')),
        (f'share/{NAME}/layouts', glob('layouts/*')),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},
    zip_safe=False,
    entry_points={
        'console_scripts': [
            'description_node = hexapod_bringup.executables:description_node',
            'doctor = hexapod_bringup.doctor:main',
            'layout = hexapod_bringup.layout:main',
            'realtime_report = hexapod_bringup.realtime_report:main',
            'watch = hexapod_bringup.executables:watch',
            'worker_node = hexapod_bringup.executables:worker_node',
        ],
    },
)
